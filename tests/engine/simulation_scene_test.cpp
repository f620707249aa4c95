#include "percale/simulation.h"

#include <limits>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::simulation_scene_test {
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

}  // namespace

TEST_CASE("A rotation that is a unit quaternion to rounding is normalised exactly") {
    Simulation simulation(StepSettings{});
    const ClothId cloth = simulation.add_cloth(make_grid(1.0, 1.0, 3, 3), sheet_fabric(), {.rotation = {1.0000005, 0, 0, 0}});
    CHECK(copy(simulation.positions(cloth)) == make_grid(1.0, 1.0, 3, 3).vertices);
}

TEST_CASE("Without motion of pins or obstacles no work is done on the cloth") {
    PlaneScene scene({.measure = StepMeasures::all});
    scene.simulation.pin(scene.cloth, 0);
    for (int n = 0; n < 20; ++n) CHECK(scene.simulation.step().energy.work == 0.0);
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

TEST_CASE("The residual is that of the state at the end of a step, not of its start") {
    Simulation simulation({.newton_iterations = 1});
    simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
    // One linear solve moves a free sheet at rest as gravity does, so that the residual is zero.
    CHECK(simulation.step().residual < 1e-8);
}

TEST_CASE("A simulation without cloth, or a moved one, continues to step") {
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

TEST_CASE("Invalid settings, poses and meshes are refused by name") {
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

TEST_CASE("Cloths, vertices and obstacles that do not exist are refused with the valid range") {
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

TEST_CASE("Cloth with self_contact needs a detector that supports it") {
    Fabric fabric = sheet_fabric();
    fabric.self_contact = true;
    const auto add_to = [&](Simulation&& simulation) { simulation.add_cloth(make_grid(0.5, 0.5, 3, 3), fabric, {}, "towel"); };
    CHECK(mentions(scene_error([&] { add_to(Simulation(StepSettings{})); }), {"towel", "self_contact", "detector"}));
    CHECK(mentions(scene_error([&] { add_to(Simulation(StepSettings{}, std::make_unique<PlaneDetector>())); }),
                   {"self_contact must be false"}));
}

}  // namespace percale::test::simulation_scene_test
