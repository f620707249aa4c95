#include "percale/simulation.h"

#include <cmath>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

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

TEST_CASE("A rotation that is a unit quaternion to rounding is made exactly one") {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(1.0, 1.0, 3, 3), sheet_fabric(), {.rotation = {1.0000005, 0, 0, 0}});
    CHECK(copy(simulation.positions(cloth)) == make_grid(1.0, 1.0, 3, 3).vertices);
}

TEST_CASE("Pinned vertices keep their place exactly while the rest moves, and fall when let go") {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric(), {.translation = Vec3(0.1, 0.7, 0.3)});
    simulation.pin(cloth, 0);
    simulation.pin(cloth, 3);
    const std::vector<Vec3> start = copy(simulation.positions(cloth));
    for (int n = 0; n < 30; ++n) {
        REQUIRE(simulation.step().ok());
        for (const int pinned : {0, 3}) {
            REQUIRE(simulation.positions(cloth)[pinned] == start[pinned]);
            REQUIRE(simulation.velocities(cloth)[pinned] == Vec3::Zero());
        }
    }
    CHECK(simulation.positions(cloth)[15].y() < start[15].y() - 0.1);
    simulation.unpin(cloth, 0);
    REQUIRE(simulation.step().ok());
    CHECK(simulation.positions(cloth)[0] != start[0]);
    CHECK(simulation.positions(cloth)[3] == start[3]);
}

TEST_CASE("A moved pin reaches its target exactly in every scheme, and stays there") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4, Scheme::backward_euler}) {
        Simulation simulation({.time_step = 1e-4, .scheme = scheme});
        const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
        simulation.pin(cloth, 5);
        for (int n = 1; n <= 10; ++n) {
            const Vec3 target = make_grid(0.5, 0.5, 4, 4).vertices[5] + Vec3(0.001, 0.0007, -0.0003) * n / 3.0;
            simulation.move_pin(cloth, 5, target);
            REQUIRE(simulation.step().ok());
            CHECK(simulation.positions(cloth)[5] == target);
        }
        const Vec3 last = simulation.positions(cloth)[5];
        REQUIRE(simulation.step().ok());
        CHECK(simulation.positions(cloth)[5] == last);
        CHECK(simulation.velocities(cloth)[5] == Vec3::Zero());
    }
}

TEST_CASE("Pinning twice, or a moving vertex, holds it where it is") {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
    for (int n = 0; n < 5; ++n) simulation.step();
    simulation.pin(cloth, 7);
    simulation.move_pin(cloth, 7, Vec3(9, 9, 9));
    simulation.pin(cloth, 7);  // forgets the target
    const Vec3 held = simulation.positions(cloth)[7];
    CHECK(simulation.velocities(cloth)[7] == Vec3::Zero());
    REQUIRE(simulation.step().ok());
    CHECK(simulation.positions(cloth)[7] == held);
}

TEST_CASE("A plane that moves up and sideways takes the cloth along and ends where it was sent") {
    PlaneScene scene({.measure = StepMeasures::all});
    for (int n = 0; n < 60; ++n) REQUIRE(scene.simulation.step().ok());  // at rest on the plane
    double before = 0.0;
    for (const Vec3& x : scene.simulation.positions(scene.cloth)) before += x.x() / 16;
    for (int n = 1; n <= 60; ++n) {
        const Vec3 place(0.002 * n, 0.003 * n, 0.0);
        scene.simulation.move_obstacle(scene.plane, {.translation = place});
        const StepReport report = scene.simulation.step();
        REQUIRE(report.ok());
        CHECK(report.energy.work > 0.0);
        CHECK(scene.simulation.obstacle_pose(scene.plane).translation == place);
        for (const Vec3& x : scene.simulation.positions(scene.cloth)) REQUIRE(x.y() > place.y());
    }
    double after = 0.0;
    for (const Vec3& x : scene.simulation.positions(scene.cloth)) after += x.x() / 16;
    // Friction 0.3 can give 3 m/s^2; the plane needs 0.12 m/s.
    CHECK(after - before == Approx(0.12).epsilon(0.05));
}

TEST_CASE("A pin dragged through the plane fails with names and leaves every bit") {
    PlaneScene scene;
    scene.simulation.pin(scene.cloth, 6);
    for (int n = 0; n < 5; ++n) REQUIRE(scene.simulation.step().ok());
    const std::vector<Vec3> positions = copy(scene.simulation.positions(scene.cloth));
    const std::vector<Vec3> velocities = copy(scene.simulation.velocities(scene.cloth));
    const std::uint64_t hash = scene.simulation.state_hash();
    const double time = scene.simulation.time();
    scene.simulation.move_pin(scene.cloth, 6, positions[6] - Vec3(0, 0.1, 0));
    const StepReport report = scene.simulation.step();
    CHECK(report.status == StepStatus::pin_blocked);
    CHECK(report.blocked_cloth == scene.cloth.index);
    CHECK(report.blocked_vertex == 6);
    CHECK(report.blocked_name == "towel");
    CHECK(mentions(report.explanation(), {"pin_blocked", "vertex 6", "cloth 0 (towel)", "obstacle 0 (floor)"}));
    CHECK(copy(scene.simulation.positions(scene.cloth)) == positions);
    CHECK(copy(scene.simulation.velocities(scene.cloth)) == velocities);
    CHECK(scene.simulation.state_hash() == hash);
    CHECK(scene.simulation.time() == time);
    scene.simulation.move_pin(scene.cloth, 6, positions[6] + Vec3(0, 0.001, 0));
    CHECK(scene.simulation.step().ok());
}

TEST_CASE("An obstacle that drives through held cloth fails and stays where it was") {
    PlaneScene scene;
    for (int i = 0; i < 16; ++i) scene.simulation.pin(scene.cloth, i);
    const std::uint64_t hash = scene.simulation.state_hash();
    scene.simulation.move_obstacle(scene.plane, {.translation = Vec3(0, 0.1, 0)});
    const StepReport report = scene.simulation.step();
    CHECK(report.status == StepStatus::obstacle_too_fast);
    CHECK(scene.simulation.state_hash() == hash);
    CHECK(scene.simulation.obstacle_pose(scene.plane).translation == Vec3::Zero());
    scene.simulation.move_obstacle(scene.plane, {});
    CHECK(scene.simulation.step().ok());
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

TEST_CASE("Without motion of pins or obstacles nobody works on the cloth") {
    PlaneScene scene({.measure = StepMeasures::all});
    scene.simulation.pin(scene.cloth, 0);
    for (int n = 0; n < 20; ++n) CHECK(scene.simulation.step().energy.work == 0.0);
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

TEST_CASE("A second cloth leaves the first one's state and pins alone") {
    Simulation simulation(StepSettings{}), alone(StepSettings{});
    ClothId cloth, same;
    for (auto [each, id] : {std::pair(&simulation, &cloth), std::pair(&alone, &same)}) {
        *id = each->add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
        each->pin(*id, 2);
        for (int n = 0; n < 5; ++n) each->step();
    }
    const ClothId second = simulation.add_cloth(make_grid(1.0, 1.0, 3, 3), sheet_fabric(), {.translation = Vec3(5, 0, 0)});
    CHECK(simulation.cloth_count() == 2);
    CHECK(copy(simulation.positions(cloth)) == copy(alone.positions(same)));
    CHECK(copy(simulation.velocities(cloth)) == copy(alone.velocities(same)));
    CHECK(simulation.time() == alone.time());
    CHECK(copy(simulation.positions(second))[0] == Vec3(4.5, 0, -0.5));
    CHECK(copy(simulation.velocities(second))[0] == Vec3::Zero());
    const Vec3 pinned = simulation.positions(cloth)[2];
    CHECK_NOTHROW(simulation.unpin(cloth, 2));
    simulation.pin(cloth, 2);
    REQUIRE(simulation.step().ok());
    CHECK(simulation.positions(cloth)[2] == pinned);
    CHECK(simulation.positions(second)[4].y() == Approx(-9.81 / 3600).epsilon(1e-6));
}

TEST_CASE("Two cloths of one simulation move as each would alone") {
    const StepSettings settings{.newton_tolerance = 1e-11};
    Simulation both(settings), first(settings), second(settings);
    const auto add = [](Simulation& simulation, double place) {
        const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric(), {.translation = Vec3(place, 0, 0)});
        simulation.pin(cloth, place > 0.0 ? 0 : 15);
        return cloth;
    };
    const ClothId a = add(both, 0.0), b = add(both, 2.0), c = add(first, 0.0), d = add(second, 2.0);
    for (int n = 0; n < 20; ++n) {
        for (auto* each : {&both, &first, &second}) REQUIRE(each->step().ok());
    }
    CHECK(largest_difference(copy(both.positions(a)), copy(first.positions(c))) < 1e-8);
    CHECK(largest_difference(copy(both.positions(b)), copy(second.positions(d))) < 1e-8);
}

TEST_CASE("The residual is that of the state a step ends in, not of the one it came from") {
    Simulation simulation({.newton_iterations = 1});
    simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
    // One linear solve moves a free sheet at rest to where gravity takes it, so nothing is left over.
    CHECK(simulation.step().residual < 1e-8);
}

TEST_CASE("Pins that carry a whole sheet do the work that its energy gains, in explicit schemes too") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4}) {
        Simulation simulation({.time_step = 1e-3, .scheme = scheme, .measure = StepMeasures::all});
        const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
        for (int i = 0; i < 9; ++i) simulation.pin(cloth, i);
        for (int n = 0; n < 3; ++n) {
            const double before = simulation.energy().total();
            for (int i = 0; i < 9; ++i)
                simulation.move_pin(cloth, i, simulation.positions(cloth)[i] + Vec3(0, 0.01 * (n + 1), 0));
            const StepReport report = simulation.step();
            CHECK(report.energy.work > 0.1);
            CHECK(report.energy.work == Approx(report.energy.total() - before).epsilon(1e-9));
        }
    }
}

TEST_CASE("A simulation without cloth, or that was moved, steps on") {
    Simulation empty(StepSettings{});
    CHECK(empty.step().ok());
    CHECK(empty.time() == 1.0 / 60.0);
    Simulation moved = std::move(empty);
    const ClothId cloth = moved.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
    Simulation target(StepSettings{});
    moved.step();
    target = std::move(moved);
    CHECK(target.step().ok());
    CHECK(target.positions(cloth)[4].y() == Approx(-3.0 * 9.81 / 3600).epsilon(1e-6));
}

TEST_CASE("Gravity and the time step may change during a run") {
    Simulation simulation(StepSettings{.newton_tolerance = 1e-10});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
    simulation.set_gravity(Vec3(1.0, 0.0, 0.0));
    simulation.set_time_step(0.25);
    REQUIRE(simulation.step().ok());
    CHECK(simulation.time() == 0.25);
    CHECK((simulation.velocities(cloth)[4] - Vec3(0.25, 0, 0)).norm() < 1e-12);
}

TEST_CASE("Settings, poses and meshes that cannot be are refused by name") {
    CHECK(mentions(scene_error([] { Simulation simulation({.time_step = 0.0}); }), {"settings", "time_step", "0"}));
    Simulation simulation(StepSettings{});
    const TriangleMesh grid = make_grid(0.5, 0.5, 3, 3);
    const auto add = [&](const Pose& pose) {
        return scene_error([&] { simulation.add_cloth(grid, sheet_fabric(), pose, "flag"); });
    };
    CHECK(mentions(add({.translation = Vec3(nan_value, 0, 0)}), {"flag", "translation"}));
    CHECK(mentions(add({.rotation = {2.0, 0, 0, 0}}), {"flag", "rotation", "2", "unit quaternion"}));
    CHECK(mentions(add({.rotation = {nan_value, 0, 0, 0}}), {"flag", "rotation"}));
    CHECK(mentions(add({.scale = 0.0}), {"flag", "scale", "0"}));
    CHECK(mentions(add({.scale = -2.5}), {"flag", "scale", "-2.5"}));
    CHECK(simulation.cloth_count() == 0);
    CHECK(mentions(scene_error([&] { simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.3, .name = "floor"}); }),
                   {"floor", "contact detector"}));
    Simulation touching(StepSettings{}, std::make_unique<PlaneDetector>());
    const auto obstacle = [&](const TriangleMesh& mesh, const Pose& pose, double friction) {
        return scene_error([&] { touching.add_obstacle(mesh, pose, {.friction = friction, .name = "floor"}); });
    };
    for (const double bad : {-0.1, 10.5, nan_value}) {
        CHECK(mentions(obstacle(make_plane(1.0), {}, bad), {"floor", "friction", "0 ... 10"}));
    }
    CHECK(mentions(obstacle({}, {}, 0.3), {"floor", "no triangles"}));
    CHECK(mentions(obstacle(make_plane(1.0), {.scale = -1.0}, 0.3), {"floor", "scale", "-1"}));
}

TEST_CASE("Cloths, vertices and obstacles that do not exist are refused with the range of those that do") {
    PlaneScene scene;
    Simulation& s = scene.simulation;
    const auto no_cloth = [](const std::string& text, const char* number) {
        return mentions(text, {"no cloth", number, "0 ... 0"});
    };
    for (const int bad : {-1, 1}) {
        const ClothId id{bad};
        const std::string number = std::to_string(bad);
        CHECK(no_cloth(scene_error([&] { s.pin(id, 0); }), number.c_str()));
        CHECK(no_cloth(scene_error([&] { s.positions(id); }), number.c_str()));
        CHECK(no_cloth(scene_error([&] { s.velocities(id); }), number.c_str()));
        CHECK(no_cloth(scene_error([&] { s.masses(id); }), number.c_str()));
        CHECK(mentions(scene_error([&] { s.move_obstacle({bad}, {}); }), {"no obstacle", number, "0 ... 0"}));
        CHECK(mentions(scene_error([&] { s.obstacle_pose({bad}); }), {"no obstacle", number}));
    }
    for (const int bad : {-1, 16}) {
        const std::vector<std::string> expected = {"towel", "no vertex " + std::to_string(bad), "0 ... 15"};
        CHECK(mentions(scene_error([&] { s.pin(scene.cloth, bad); }), expected));
        CHECK(mentions(scene_error([&] { s.unpin(scene.cloth, bad); }), expected));
        CHECK(mentions(scene_error([&] { s.move_pin(scene.cloth, bad, Vec3::Zero()); }), expected));
    }
}

TEST_CASE("Calls with wrong values are refused and change nothing") {
    PlaneScene scene;
    Simulation& s = scene.simulation;
    s.pin(scene.cloth, 4);
    const std::uint64_t hash = s.state_hash();
    const std::vector<Vec3> few(15, Vec3::Zero());
    std::vector<Vec3> bad(16, Vec3(1, 1, 1));
    bad[11].y() = nan_value;
    CHECK(mentions(scene_error([&] { s.unpin(scene.cloth, 3); }), {"towel", "unpin", "vertex 3", "not pinned"}));
    CHECK(mentions(scene_error([&] { s.move_pin(scene.cloth, 3, Vec3::Zero()); }),
                   {"towel", "move_pin", "vertex 3", "not pinned"}));
    CHECK(mentions(scene_error([&] { s.move_pin(scene.cloth, 4, bad[11]); }), {"towel", "vertex 4", "not finite"}));
    CHECK(mentions(scene_error([&] { s.move_obstacle(scene.plane, {.scale = 2.0}); }), {"floor", "scale"}));
    CHECK(mentions(scene_error([&] { s.move_obstacle(scene.plane, {.rotation = {0, 0, 0, 0}}); }), {"floor", "rotation"}));
    CHECK(mentions(scene_error([&] { s.set_gravity(bad[11]); }), {"set_gravity", "gravity"}));
    CHECK(mentions(scene_error([&] { s.set_time_step(-1.0); }), {"set_time_step", "time_step", "-1"}));
    CHECK(mentions(scene_error([&] { s.set_positions(scene.cloth, few); }), {"towel", "set_positions", "15", "16"}));
    CHECK(mentions(scene_error([&] { s.set_velocities(scene.cloth, few); }), {"towel", "set_velocities", "15", "16"}));
    CHECK(mentions(scene_error([&] { s.set_positions(scene.cloth, bad); }), {"towel", "position 11", "not finite"}));
    CHECK(mentions(scene_error([&] { s.set_velocities(scene.cloth, bad); }), {"towel", "velocity 11", "not finite"}));
    CHECK(s.state_hash() == hash);
    CHECK(s.step().dt == 1.0 / 60.0);
}

TEST_CASE("A start inside an obstacle is refused by prepare and by the first step") {
    PlaneScene scene;
    std::vector<Vec3> positions = copy(scene.simulation.positions(scene.cloth));
    positions[9].y() = -0.01;
    scene.simulation.set_positions(scene.cloth, positions);
    CHECK(mentions(scene_error([&] { scene.simulation.prepare(); }), {"inside", "floor", "vertex 9 of towel"}));
    CHECK(mentions(scene_error([&] { scene.simulation.step(); }), {"inside", "floor"}));
    CHECK_THROWS_AS(scene.simulation.prepare(), StartError);
    positions[9].y() = 0.01;
    scene.simulation.set_positions(scene.cloth, positions);
    CHECK_NOTHROW(scene.simulation.prepare());
    CHECK(scene.simulation.step().ok());
}

TEST_CASE("Explicit schemes refuse obstacles") {
    PlaneScene scene({.time_step = 1e-4, .scheme = Scheme::rk4});
    CHECK(mentions(scene_error([&] { scene.simulation.prepare(); }), {"explicit", "backward_euler"}));
    CHECK_FALSE(scene_error([&] { scene.simulation.step(); }).empty());
}

TEST_CASE("Velocities set on pinned vertices are not taken over") {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), sheet_fabric());
    simulation.pin(cloth, 1);
    simulation.set_velocities(cloth, std::vector<Vec3>(9, Vec3(1, 2, 3)));
    CHECK(simulation.velocities(cloth)[1] == Vec3::Zero());
    CHECK(simulation.velocities(cloth)[2] == Vec3(1, 2, 3));
}

TEST_CASE("Cloth that is to meet cloth needs a detector that can do that") {
    Fabric fabric = sheet_fabric();
    fabric.self_contact = true;
    const auto add_to = [&](Simulation&& simulation) { simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), fabric, {}, "towel"); };
    CHECK(mentions(scene_error([&] { add_to(Simulation(StepSettings{})); }), {"towel", "self_contact", "detector"}));
    CHECK(mentions(scene_error([&] { add_to(Simulation(StepSettings{}, std::make_unique<PlaneDetector>())); }),
                   {"self_contact must be false"}));
}

}  // namespace percale::test
