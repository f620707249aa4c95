#include "engine/changes/scene_changes.h"

#include <algorithm>
#include <array>
#include <functional>
#include <tuple>

#include "tests/support/catch.h"
#include "tests/support/slope_scene.h"

namespace percale::test::scene_changes_test {
namespace {

Fabric soft_fabric() {
    Fabric fabric = free_fabric();
    fabric.springs.structural = 200.0;
    return fabric;
}

TriangleMesh free_mesh(int columns, int rows) {
    TriangleMesh mesh = make_grid(0.3, 0.2, columns, rows);
    mesh.grid_columns = mesh.grid_rows = 0;
    return mesh;
}

/// Three cloths; seams join the first two and were sewn before the third was added; the middle one is of `fabric`.
struct SewnScene {
    Simulation simulation;
    ClothId left, middle, right;
    SeamId seam, inner;

    explicit SewnScene(const Fabric& fabric, bool grid) : simulation(StepSettings{}) {
        TriangleMesh mesh = make_grid(0.3, 0.2, 6, 5);
        if (!grid) mesh.grid_columns = mesh.grid_rows = 0;
        left = simulation.add_cloth(free_mesh(5, 4), soft_fabric(), {.translation = Vec3(-0.31, 0, 0)}, "left");
        middle = simulation.add_cloth(mesh, fabric, {}, "middle");
        seam = simulation.add_seam(left, middle, std::vector<std::array<int, 2>>{{4, 0}, {19, 24}}, {.over = 0.0});
        inner = simulation.add_seam(middle, middle, std::vector<Stitch>{{5, 12, 18, 0.3}}, {.over = 0.0, .stiffness = 1.0});
        right = simulation.add_cloth(free_mesh(4, 4), soft_fabric(), {.translation = Vec3(0.4, 0, 0)}, "right");
        simulation.pin(left, 0);
        simulation.pin(middle, 5);
        simulation.pin(right, 3);
    }
    void run(int steps) {
        for (int n = 0; n < steps; ++n) REQUIRE(simulation.step().ok());
    }
    /// Copies the state of another scene of the same meshes.
    void take(const SewnScene& other) {
        for (const ClothId cloth : {left, middle, right}) {
            const std::vector<Vec3> x = copy(other.simulation.positions(cloth)), v = copy(other.simulation.velocities(cloth));
            simulation.set_positions(cloth, x);
            simulation.set_velocities(cloth, v);
        }
    }
};

std::vector<Fabric> fabrics(bool grid) {
    const Fabric plain = grid ? sheet_fabric() : free_fabric();
    std::vector<Fabric> all(9, plain);
    all[1].springs.structural = 77.0;
    all[2].area_density = 0.05;
    all[3].spring_damping = 0.0;
    all[4].thickness = 0.001;
    all[5].springs.bend = 0.0;
    all[5].bend_stiffness = 1e-3;
    all[6].springs = {.structural = 0.0};
    all[6].stretch_stiffness = {{400.0, 400.0}};
    all[7].strain_limit = 0.02;
    all[8].springs.bend = 0.0;
    return all;
}

}  // namespace

TEST_CASE("A cloth of another fabric makes the steps of one that was built with it and has its state, in every bit") {
    for (const bool grid : {true, false}) {
        const std::vector<Fabric> all = fabrics(grid);
        for (std::size_t k = 0; k < all.size(); ++k) {
            CAPTURE(grid, k);
            SewnScene changed(all[(k + 4) % all.size()], grid), built(all[k], grid);
            changed.run(10);
            changed.simulation.set_fabric(changed.middle, all[k]);
            built.take(changed);
            REQUIRE(changed.simulation.state_hash() == built.simulation.state_hash());
            CHECK(std::ranges::equal(changed.simulation.masses(changed.middle), built.simulation.masses(built.middle)));
            for (int n = 0; n < 10; ++n) {
                changed.run(1);
                built.run(1);
                REQUIRE(changed.simulation.state_hash() == built.simulation.state_hash());
            }
        }
    }
}

TEST_CASE("Another fabric leaves every position, velocity and pin where it is, whatever the internal order") {
    SewnScene scene(free_fabric(), false);
    scene.simulation.keep_previous_positions();
    scene.run(10);
    Simulation& s = scene.simulation;
    const std::vector<Vec3> x = copy(s.positions(scene.middle)), v = copy(s.velocities(scene.middle));
    const std::vector<Vec3> left = copy(s.positions(scene.left));
    std::vector<Vec3> before(30), after(30);
    s.interpolate(0.25, scene.middle, before);
    Fabric bare = free_fabric();
    bare.springs.bend = 0.0;
    s.set_fabric(scene.middle, bare);
    CHECK(copy(s.positions(scene.middle)) == x);
    CHECK(copy(s.velocities(scene.middle)) == v);
    CHECK(copy(s.positions(scene.left)) == left);
    s.interpolate(0.25, scene.middle, after);
    CHECK(after == before);
    scene.run(5);
    CHECK(s.positions(scene.middle)[5] == x[5]);
    CHECK(s.positions(scene.middle)[6] != x[6]);
    CHECK_THROWS_AS(s.unpin(scene.middle, 6), SceneError);
    s.unpin(scene.middle, 5);
    scene.run(1);
    CHECK(s.positions(scene.middle)[5] != x[5]);
}

TEST_CASE("Cloth of a thicker fabric rises to its own height, and cloth of another weight presses with it") {
    SlopeScene scene(0.3, false);
    scene.run(60);
    const double low = scene.simulation.positions(scene.cloth)[5].y(), press = scene.simulation.force_on(scene.plane).y();
    Fabric thick = sheet_fabric();
    thick.thickness = 0.02;
    scene.simulation.set_fabric(scene.cloth, thick);
    scene.run(200);
    CHECK(low < 0.005);
    CHECK(scene.simulation.positions(scene.cloth)[5].y() > 0.0149);
    thick.area_density *= 3.0;
    scene.simulation.set_fabric(scene.cloth, thick);
    scene.run(200);
    CHECK(scene.simulation.force_on(scene.plane).y() == Approx(3.0 * press).epsilon(0.02));
}

TEST_CASE("Stiffness may change while cloth lies in contact: the contacts are kept, and cloth at rest wakes") {
    SlopeScene scene(5.0);
    while (!scene.simulation.step().slept) REQUIRE(scene.simulation.time() < 20.0);
    const Vec3 force = scene.simulation.force_on(scene.plane);
    const std::vector<Vec3> x = copy(scene.simulation.positions(scene.cloth));
    Fabric stiff = sheet_fabric();
    stiff.springs.structural *= 4.0;
    scene.simulation.set_fabric(scene.cloth, stiff);
    CHECK(scene.simulation.force_on(scene.plane) == force);
    CHECK_FALSE(scene.simulation.step().slept);
    scene.run(20);
    CHECK(largest_difference(copy(scene.simulation.positions(scene.cloth)), x) < 2e-4);
}

TEST_CASE("A fabric that the cloth cannot have is refused as by add_cloth, and nothing has changed") {
    SewnScene scene(free_fabric(), false);
    scene.run(3);
    Simulation& s = scene.simulation;
    Fabric wrong = free_fabric();
    wrong.springs.shear = 5.0;
    check_refused(s, [&] { s.set_fabric(scene.middle, wrong); }, {"middle", "springs.shear"});
    wrong = free_fabric();
    wrong.area_density = -1.0;
    check_refused(s, [&] { s.set_fabric(scene.middle, wrong); }, {"middle", "area_density"});
    wrong = free_fabric();
    wrong.springs = {.structural = 0.0, .shear = 0.0, .bend = 0.0};
    check_refused(s, [&] { s.set_fabric(scene.middle, wrong); }, {"middle", "no springs"});
    wrong = free_fabric();
    wrong.self_contact = true;
    check_refused(s, [&] { s.set_fabric(scene.middle, wrong); }, {"middle", "self_contact needs a contact detector"});
    wrong = free_fabric();
    wrong.pressure = 5.0;
    check_refused(s, [&] { s.set_fabric(scene.middle, wrong); }, {"middle", "closed mesh"});
    check_refused(s, [&] { s.set_fabric({3}, free_fabric()); }, {"no cloth 3"});
}

TEST_CASE("A fabric that the detector cannot have is refused before anything changes (loads stay, and so do all later steps)") {
    SlopeScene plane(0.3), untouched(0.3);
    plane.run(3);
    untouched.run(3);
    Fabric wrong = sheet_fabric();
    wrong.self_contact = true;  // which a plane detector does not support
    wrong.thickness = 0.02;
    CHECK(mentions(scene_error([&] { plane.simulation.set_fabric(plane.cloth, wrong); }), {"self_contact must be false"}));
    const std::vector<ContactLoad> loads = plane.simulation.contact_loads(plane.cloth),
                                   wanted = untouched.simulation.contact_loads(untouched.cloth);
    REQUIRE(loads.size() == wanted.size());
    for (std::size_t i = 0; i < loads.size(); ++i) CHECK(loads[i].normal == wanted[i].normal);
    for (int step = 0; step < 5; ++step) {
        const StepReport here = plane.simulation.step(), there = untouched.simulation.step();
        CHECK(plane.simulation.state_hash() == untouched.simulation.state_hash());
        CHECK(here.contact_hash == there.contact_hash);
        CHECK(here.newton_iterations == there.newton_iterations);
    }
}

TEST_CASE("After a cloth was removed the steps are those of a simulation without it, in every bit") {
    for (const int removed : {0, 1, 2}) {
        CAPTURE(removed);
        SewnScene scene(free_fabric(), false);
        scene.run(removed == 1 ? 0 : 8);
        scene.simulation.remove_cloth({removed});
        // Made by the same calls without that cloth.
        Simulation never(StepSettings{});
        std::vector<std::array<ClothId, 2>> same;
        if (removed != 0)
            same.push_back(
                {scene.left, never.add_cloth(free_mesh(5, 4), soft_fabric(), {.translation = Vec3(-0.31, 0, 0)}, "left")});
        if (removed != 1) same.push_back({scene.middle, never.add_cloth(free_mesh(6, 5), free_fabric(), {}, "middle")});
        if (removed == 2) never.add_seam({0}, {1}, std::vector<std::array<int, 2>>{{4, 0}, {19, 24}}, {.over = 0.0});
        if (removed != 1) {
            const ClothId middle = same.back()[1];
            never.add_seam(middle, middle, std::vector<Stitch>{{5, 12, 18, 0.3}}, {.over = 0.0, .stiffness = 1.0});
        }
        if (removed != 2)
            same.push_back(
                {scene.right, never.add_cloth(free_mesh(4, 4), soft_fabric(), {.translation = Vec3(0.4, 0, 0)}, "right")});
        CHECK(scene.simulation.cloth_count() == 2);
        for (const auto& [here, there] : same) {
            never.pin(there, here.index == 0 ? 0 : here.index == 1 ? 5 : 3);
            const std::vector<Vec3> x = copy(scene.simulation.positions(here)), v = copy(scene.simulation.velocities(here));
            never.set_positions(there, x);
            never.set_velocities(there, v);
        }
        REQUIRE(scene.simulation.state_hash() == never.state_hash());
        for (int n = 0; n < 15; ++n) {
            scene.run(1);
            REQUIRE(never.step().ok());
            REQUIRE(scene.simulation.state_hash() == never.state_hash());
        }
    }
}

TEST_CASE("After a cloth was removed the others keep ids, pins, seams and views") {
    SewnScene scene(free_fabric(), false);
    scene.simulation.keep_previous_positions();
    scene.run(5);
    Simulation& s = scene.simulation;
    const std::vector<Vec3> x = copy(s.positions(scene.right)), v = copy(s.velocities(scene.right));
    const std::vector<double> masses(s.masses(scene.right).begin(), s.masses(scene.right).end()), gaps = s.seam_gaps(scene.inner);
    std::vector<Vec3> before(16), after(16);
    s.interpolate(0.5, scene.right, before);
    s.remove_cloth(scene.left);
    s.interpolate(0.5, scene.right, after);
    CHECK(after == before);
    CHECK(copy(s.positions(scene.right)) == x);
    CHECK(copy(s.velocities(scene.right)) == v);
    CHECK(std::ranges::equal(s.masses(scene.right), masses));
    CHECK(s.seam_gaps(scene.inner) == gaps);
    check_refused(s, [&] { s.seam_gaps(scene.seam); }, {"seam 0 was removed"});
    scene.run(3);
    CHECK(s.positions(scene.right)[3] == x[3]);
    const ClothId added = s.add_cloth(free_mesh(4, 4), soft_fabric(), {.translation = Vec3(2, 0, 0)});
    CHECK(added.index == 3);
    CHECK(s.add_seam(scene.right, added, std::vector<std::array<int, 2>>{{0, 0}}).index == 2);
    scene.run(3);
    s.remove_cloth(scene.right);
    s.remove_cloth(scene.middle);
    s.remove_cloth(added);
    CHECK(s.cloth_count() == 0);
    scene.run(3);
    CHECK(s.energy().total() == 0.0);
    CHECK(s.add_cloth(free_mesh(4, 4), soft_fabric()).index == 4);
    scene.run(3);
}

TEST_CASE("After removing an obstacle that nothing touched, the steps are those without it, asleep and in every bit") {
    for (const int until : {5, 60}) {
        SlopeScene with(5.0), without(5.0);
        const ObstacleId far = with.simulation.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -3, 0)});
        bool slept = false;
        for (int n = 0; n < 400 && !slept; ++n) {
            if (n == until) with.simulation.remove_obstacle(far);
            const StepReport one = with.simulation.step(), other = without.simulation.step();
            REQUIRE(one.ok());
            REQUIRE(one.slept == other.slept);
            REQUIRE(with.simulation.state_hash() == without.simulation.state_hash());
            slept = one.slept && n > until;
        }
        CHECK(slept);
        CHECK(with.simulation.force_on(with.plane) == without.simulation.force_on(without.plane));
    }
}

TEST_CASE("Cloth falls freely when the only obstacle is removed, whatever the contact response") {
    for (const auto response : {ContactResponse::penalty, ContactResponse::projection}) {
        Simulation s({.contact_response = response}, std::make_unique<PlaneDetector>());
        const ClothId cloth = s.add_cloth(make_grid(0.2, 0.2, 4, 4), sheet_fabric(), {.translation = Vec3(0, 0.0045, 0)});
        const ObstacleId plane = s.add_obstacle(make_plane(1.0), {});
        for (int n = 0; n < 30; ++n) REQUIRE(s.step().ok());
        REQUIRE(s.force_on(plane).y() < 0.0);
        const double before = s.velocities(cloth)[5].y();
        s.remove_obstacle(plane);
        for (int n = 0; n < 3; ++n) REQUIRE(s.step().ok());
        CHECK(s.velocities(cloth)[5].y() - before == Approx(-3.0 / 60.0 * 9.81).epsilon(1e-3));
    }
}

TEST_CASE("Cloth falls when its support is removed, and what presses it further is reported by its own id") {
    SlopeScene scene(5.0, false);
    Simulation& s = scene.simulation;
    while (!s.step().slept) REQUIRE(s.time() < 20.0);
    const ObstacleId below = s.add_obstacle(make_plane(1.0), {.translation = Vec3(0, -0.1, 0)}, {.name = "cellar"});
    while (!s.step().slept) REQUIRE(s.time() < 40.0);
    s.remove_obstacle(scene.plane);
    CHECK(s.contact_loads(scene.cloth).empty());
    scene.run(5);
    CHECK(s.largest_speed() == Approx(5.0 / 60.0 * 9.81).epsilon(0.01));
    scene.run(100);
    CHECK(s.force_on(below).y() < -0.9 * 9.81 * 0.2 * 0.04);
    REQUIRE(s.contact_loads(scene.cloth).size() == 16);
    for (const ContactLoad& load : s.contact_loads(scene.cloth)) CHECK(load.obstacle == below.index);
    // A failed step names it, too, and so does a refused start.
    s.move_obstacle(below, {.translation = Vec3(0, 300, 0)});
    const StepReport report = s.step();
    REQUIRE_FALSE(report.ok());
    CHECK(report.blocking_obstacle == below.index);
    s.move_obstacle(below, {.translation = Vec3(0, -0.1, 0)});
    std::vector<Vec3> through = copy(s.positions(scene.cloth));
    for (Vec3& x : through) x.y() -= 0.05;
    s.set_positions(scene.cloth, through);
    try {
        s.step();
        FAIL("a start below the plane");
    } catch (const StartError& error) {
        CHECK(error.fault().obstacle == below.index);
        CHECK(mentions(error.what(), {"cellar"}));
    }
    s.remove_obstacle(below);
    scene.run(2);
}

}  // namespace percale::test::scene_changes_test
