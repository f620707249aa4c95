#include "percale/simulation.h"

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::simulation_views_test {
namespace {

/// A sheet 2 cm above a plane at y = 0.
struct PlaneScene {
    Simulation simulation;
    ClothId cloth;
    ObstacleId plane;

    explicit PlaneScene(const StepSettings& settings = {}) : simulation(settings, std::make_unique<PlaneDetector>()) {
        cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric(), {.translation = Vec3(0, 0.02, 0)}, "towel");
        plane = simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.3, .name = "floor"});
    }
};

std::uint64_t hash_with(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
    simulation.set_positions(cloth, positions);
    simulation.set_velocities(cloth, velocities);
    return simulation.state_hash();
}

}  // namespace

TEST_CASE("Views have one entry a vertex and show the cloth at its pose") {
    Simulation simulation(StepSettings{});
    const TriangleMesh grid = make_grid(1.0, 1.0, 5, 4);
    const Pose pose{.translation = Vec3(1, 2, 3), .rotation = {0.6, 0.0, 0.8, 0.0}, .scale = 2.0};
    const ClothId cloth = simulation.add_cloth(grid, sheet_fabric(), pose);
    CHECK(simulation.cloth_count() == 1);
    REQUIRE(simulation.positions(cloth).size() == 20);
    REQUIRE(simulation.velocities(cloth).size() == 20);
    REQUIRE(simulation.masses(cloth).size() == 20);
    CHECK(copy(simulation.positions(cloth)) == transform(pose, grid.vertices));
    double mass = 0.0;
    for (const double m : simulation.masses(cloth)) mass += m;
    CHECK(mass == Approx(0.2 * 4.0).epsilon(1e-13));  // the scale belongs to the rest shape
    CHECK(simulation.energy().elastic < 1e-20);
    CHECK(simulation.energy().kinetic == 0.0);
}

TEST_CASE("Normals are those of the present state, in the user's order, into a vector or the caller's memory") {
    Simulation simulation(StepSettings{});
    TriangleMesh sheet = make_grid(0.4, 0.3, 6, 5);
    sheet.grid_columns = sheet.grid_rows = 0;  // another internal order
    simulation.add_cloth(make_grid(0.3, 0.3, 3, 3), sheet_fabric(), {.translation = Vec3(0, 1, 0)});
    const ClothId cloth = simulation.add_cloth(sheet, free_fabric(), {}, "sheet");
    simulation.pin(cloth, 0);
    for (int n = 0; n < 20; ++n) REQUIRE(simulation.step().ok());
    const std::span<const Vec3> x = simulation.positions(cloth);
    std::vector<Vec3> expected(x.size(), Vec3::Zero());
    for (const auto& [a, b, c] : sheet.triangles) {
        for (const int vertex : {a, b, c}) expected[vertex] += (x[b] - x[a]).cross(x[c] - x[a]);
    }
    const std::vector<Vec3> normals = simulation.normals(cloth);
    REQUIRE(normals.size() == 30);
    for (std::size_t i = 0; i < normals.size(); ++i) CHECK((normals[i] - expected[i].normalized()).norm() < 1e-14);
    CHECK(normals[0].y() < 0.9);  // it hangs
    std::vector<Vec3> out(30);
    simulation.normals(cloth, out);
    CHECK(out == normals);
    const std::uint64_t hash = simulation.state_hash();
    std::vector<Vec3> small(29);
    CHECK(mentions(scene_error([&] { simulation.normals(cloth, small); }), {"sheet", "29", "30 vertices"}));
    CHECK_THROWS_AS(simulation.normals({2}), SceneError);
    CHECK(simulation.state_hash() == hash);
}

TEST_CASE("Between two steps positions lie on straight lines from one state to the next") {
    Simulation simulation(StepSettings{});
    TriangleMesh sheet = make_grid(0.4, 0.3, 6, 5);
    sheet.grid_columns = sheet.grid_rows = 0;
    simulation.add_cloth(make_grid(0.3, 0.3, 3, 3), sheet_fabric(), {.translation = Vec3(0, 1, 0)});
    const ClothId cloth = simulation.add_cloth(sheet, free_fabric());
    simulation.pin(cloth, 0);
    simulation.keep_previous_positions();
    std::vector<Vec3> out(30);
    const auto at = [&](double fraction) {
        simulation.interpolate(fraction, cloth, out);
        return out;
    };
    CHECK(at(0.3) == copy(simulation.positions(cloth)));
    for (int n = 0; n < 10; ++n) {
        const std::vector<Vec3> before = copy(simulation.positions(cloth));
        REQUIRE(simulation.step().ok());
        const std::vector<Vec3> now = copy(simulation.positions(cloth));
        CHECK(at(0.0) == before);
        CHECK(at(1.0) == now);
        const std::vector<Vec3> between = at(0.25);
        for (std::size_t i = 0; i < now.size(); ++i) {
            CHECK((between[i] - (0.75 * before[i] + 0.25 * now[i])).norm() < 1e-15);
            CHECK((i == 0 || before[i] != now[i]));
        }
        CHECK(between[0] == now[0]);  // pinned
    }
}

TEST_CASE("Placing a cloth ends its interpolation, and the others keep theirs") {
    Simulation simulation(StepSettings{});
    const ClothId placed = simulation.add_cloth(make_grid(0.3, 0.3, 3, 3), sheet_fabric());
    const ClothId other = simulation.add_cloth(make_grid(0.3, 0.3, 3, 3), sheet_fabric(), {.translation = Vec3(0, 1, 0)});
    simulation.keep_previous_positions();
    const std::vector<std::byte> saved = simulation.save();
    std::vector<Vec3> out(9);
    const auto at_start = [&](ClothId cloth) {
        simulation.interpolate(0.0, cloth, out);
        return out;
    };
    const auto now = [&](ClothId cloth) { return copy(simulation.positions(cloth)); };
    const std::array<ClothId, 1> one = {placed};
    const std::vector<std::function<void()>> placings = {
        [&] { simulation.set_positions(placed, std::vector<Vec3>(make_grid(0.3, 0.3, 3, 3).vertices)); },
        [&] { simulation.reset(placed); },
        [&] { simulation.teleport(one, {}, {.translation = Vec3(0, 0, 2)}); },
    };
    for (const auto& place : placings) {
        const std::vector<Vec3> others = now(other);
        REQUIRE(simulation.step().ok());
        CHECK(at_start(placed) != now(placed));
        place();
        CHECK(at_start(placed) == now(placed));
        CHECK(at_start(other) == others);
    }
    REQUIRE(simulation.step().ok());
    const ClothId added = simulation.add_cloth(make_grid(0.3, 0.3, 3, 3), sheet_fabric(), {.translation = Vec3(0, 2, 0)});
    CHECK(at_start(added) == now(added));
    CHECK(at_start(other) != now(other));
}

TEST_CASE("After a restored state and a failed step there is nothing to interpolate") {
    PlaneScene scene;
    Simulation& s = scene.simulation;
    s.keep_previous_positions();
    std::vector<Vec3> out(16);
    const auto at_start = [&] {
        s.interpolate(0.0, scene.cloth, out);
        return out;
    };
    REQUIRE(s.step().ok());
    const auto saved = s.save();
    REQUIRE(s.step().ok());
    s.restore(saved);
    CHECK(at_start() == copy(s.positions(scene.cloth)));
    s.pin(scene.cloth, 6);
    REQUIRE(s.step().ok());
    s.move_pin(scene.cloth, 6, s.positions(scene.cloth)[6] - Vec3(0, 0.1, 0));  // through the floor
    REQUIRE_FALSE(s.step().ok());
    CHECK(at_start() == copy(s.positions(scene.cloth)));
}

TEST_CASE("Keeping positions changes no bit of any step") {
    PlaneScene plain, kept;
    kept.simulation.keep_previous_positions();
    for (int n = 0; n < 40; ++n) {
        REQUIRE(plain.simulation.step().ok());
        REQUIRE(kept.simulation.step().ok());
        REQUIRE(plain.simulation.state_hash() == kept.simulation.state_hash());
    }
    CHECK(plain.simulation.save() == kept.simulation.save());
}

TEST_CASE("Contact loads state where they act: at the vertex, and on the plane below it") {
    PlaneScene scene;
    for (int n = 0; n < 30; ++n) REQUIRE(scene.simulation.step().ok());
    const std::vector<ContactLoad> loads = scene.simulation.contact_loads(scene.cloth);
    REQUIRE(loads.size() == 16);
    for (const ContactLoad& load : loads) {
        const Vec3 x = scene.simulation.positions(scene.cloth)[load.vertex];
        CHECK(load.cloth_point == x);
        CHECK((load.obstacle_point - Vec3(x.x(), 0.0, x.z())).norm() < 1e-15);
    }
}

TEST_CASE("Torque on an obstacle is computed about a point, of an existing obstacle") {
    PlaneScene scene;
    CHECK(scene.simulation.torque_on(scene.plane, Vec3(1, 2, 3)) == Vec3::Zero());
    for (int n = 0; n < 30; ++n) REQUIRE(scene.simulation.step().ok());
    const Vec3 force = scene.simulation.force_on(scene.plane);
    const Vec3 p(0.3, -0.2, 0.7), q(-1.1, 0.4, 0.2);
    const Vec3 about_p = scene.simulation.torque_on(scene.plane, p), about_q = scene.simulation.torque_on(scene.plane, q);
    CHECK((about_p - about_q - (q - p).cross(force)).norm() < 1e-13 * force.norm());
    CHECK(about_p.norm() > 0.1 * force.norm());
    const std::uint64_t hash = scene.simulation.state_hash();
    CHECK(mentions(scene_error([&] { scene.simulation.torque_on({1}, p); }), {"no obstacle 1"}));
    const Vec3 endless(0, std::numeric_limits<double>::infinity(), 0);
    CHECK(mentions(scene_error([&] { scene.simulation.torque_on(scene.plane, endless); }), {"floor", "not finite"}));
    CHECK(scene.simulation.state_hash() == hash);
}

TEST_CASE("The report's figures are those of the state") {
    PlaneScene scene({.measure = StepMeasures::all});
    StepReport report;
    for (int n = 0; n < 20; ++n) report = scene.simulation.step();
    const StepEnergy energy = scene.simulation.energy();
    CHECK(report.energy.kinetic == energy.kinetic);
    CHECK(report.energy.gravity == energy.gravity);
    CHECK(report.energy.elastic == energy.elastic);
    CHECK(report.energy.contact == energy.contact);
    double lowest = 1.0, fastest = 0.0;
    for (const Vec3& x : scene.simulation.positions(scene.cloth)) lowest = std::min(lowest, x.y());
    for (const Vec3& v : scene.simulation.velocities(scene.cloth)) fastest = std::max(fastest, v.norm());
    CHECK(report.smallest_distance == lowest);
    CHECK(report.largest_speed == Approx(fastest).epsilon(1e-14));
    CHECK(report.largest_speed == scene.simulation.largest_speed());
    CHECK(report.largest_strain == scene.simulation.largest_strain());
    CHECK(report.time == scene.simulation.time());
    CHECK(report.linear_iterations >= report.newton_iterations);
}

TEST_CASE("The state hash depends on every bit of positions and velocities") {
    Random random(8);
    const std::vector<Vec3> positions = random_points(random, 9, 0.5), velocities = random_points(random, 9, 0.5);
    const std::uint64_t hash = hash_with(positions, velocities);
    CHECK(hash == hash_with(positions, velocities));
    for (int i = 0; i < 9; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<Vec3> other = positions;
            other[i][axis] = std::nextafter(other[i][axis], 1.0);
            CHECK(hash_with(other, velocities) != hash);
            other = velocities;
            other[i][axis] = -other[i][axis];
            CHECK(hash_with(positions, other) != hash);
        }
    }
    std::vector<Vec3> swapped = positions;
    std::swap(swapped[2], swapped[5]);
    CHECK(hash_with(swapped, velocities) != hash);
}

TEST_CASE("Pinned vertices are listed in ascending order, by the numbers of the mesh") {
    Simulation simulation(StepSettings{});
    const ClothId first = simulation.add_cloth(make_grid(1.0, 1.0, 40, 40), sheet_fabric());  // large enough for another order
    const ClothId second = simulation.add_cloth(make_grid(1.0, 1.0, 3, 3), sheet_fabric(), {.translation = Vec3(0, 1, 0)});
    CHECK(simulation.pinned_vertices(first).empty());
    for (const int vertex : {1599, 7, 800}) simulation.pin(first, vertex);
    simulation.pin(second, 4);
    CHECK(simulation.pinned_vertices(first) == std::vector{7, 800, 1599});
    CHECK(simulation.pinned_vertices(second) == std::vector{4});
    simulation.unpin(first, 800);
    CHECK(simulation.pinned_vertices(first) == std::vector{7, 1599});
    simulation.remove_cloth(first);
    CHECK(simulation.pinned_vertices(second) == std::vector{4});
    CHECK_THROWS_AS(simulation.pinned_vertices(first), SceneError);
}

}  // namespace percale::test::simulation_views_test
