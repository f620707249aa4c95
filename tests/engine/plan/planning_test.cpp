#include "engine/plan/planning.h"

#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::planning_test {
namespace {

World sheet_world(const Fabric& fabric = sheet_fabric(), const StepSettings& settings = {}) {
    TriangleMesh grid = make_grid(0.5, 0.5, 5, 4);
    for (Vec3& x : grid.vertices) x.y() += 0.02;
    return make_world(cloth_model(grid, fabric), grid.vertices, settings);
}

void add_plane(World& world) {
    world.scene.detector = std::make_unique<PlaneDetector>();
    world.scene.detector->set_cloth(world.scene.model.triangles, world.scene.model.thickness);
    world.scene.detector->add_obstacle(make_plane(1.0), {}, 0.3);
    world.scene.script.obstacles.push_back({"plane", {}, {}, 2});
}

/// Where a sheet is after half a second: pinned at two corners, one of them moving, over a plane or in the air.
std::vector<Vec3> end_of_run(StepSettings settings, const Fabric& fabric, bool plane, int& newton_iterations) {
    settings.newton_tolerance = 1e-6;
    Simulation simulation(settings, std::make_unique<PlaneDetector>());
    if (plane) simulation.add_obstacle(make_plane(1.0));
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 5, 4), fabric, {.translation = Vec3(0, 0.1, 0)});
    for (const int vertex : {0, 4}) simulation.pin(cloth, vertex);
    for (int n = 0; n < 30; ++n) {
        if (n < 10) simulation.move_pin(cloth, 0, simulation.positions(cloth)[0] + Vec3(0.005, 0, 0));
        newton_iterations += simulation.step().newton_iterations;
    }
    const auto positions = simulation.positions(cloth);
    return {positions.begin(), positions.end()};
}

}  // namespace

TEST_CASE("Facts are counted from the model and the script") {
    World world = sheet_world({.springs = {.structural = 100.0, .shear = 50.0, .bend = 0.0}, .spring_damping = 0.0});
    add_plane(world);
    world.scene.script.free[3] = 0.0;
    const SceneFacts facts = scene_facts(world.scene, world.state.cloth);
    CHECK(facts.cloth_vertices == 20);
    CHECK(facts.pinned_vertices == 1);
    CHECK(facts.cloth_triangles == 24);
    CHECK(facts.springs.structural == 4 * 4 + 5 * 3);
    CHECK(facts.springs.shear == 2 * 4 * 3);
    CHECK(facts.springs.bend == 0);
    CHECK(facts.springs.total() == static_cast<int>(world.scene.model.springs.size()));
    CHECK_FALSE(facts.damped);
    CHECK(facts.obstacles == 1);
    CHECK(facts.obstacle_triangles == 2);
    CHECK(facts.detector);
    CHECK_FALSE((facts.changes.obstacles || facts.changes.pins));
    REQUIRE(facts.cloths.size() == 1);
    CHECK(facts.cloths[0].name == "cloth");
    CHECK(facts.cloths[0].grid);
    CHECK(facts.cloths[0].fabric.springs.shear == 50.0);
}

TEST_CASE("Present motion of the script and known future motion both count as changes") {
    World world = sheet_world();
    add_plane(world);
    ScriptedChanges to_come;
    to_come.gravity = true;
    CHECK(scene_facts(world.scene, world.state.cloth, to_come).changes.gravity);
    CHECK_FALSE(scene_facts(world.scene, world.state.cloth, to_come).changes.obstacles);
    world.scene.script.obstacles[0].end.translation = Vec3(0, -0.1, 0);
    CHECK(scene_facts(world.scene, world.state.cloth).changes.obstacles);
    world.scene.script.free[2] = 0.0;
    world.scene.script.pin_targets.set(2, Vec3(0, 1, 0));
    CHECK(scene_facts(world.scene, world.state.cloth).changes.pins);
}

TEST_CASE("Pins move only if a target differs from where the pinned vertex is") {
    World world = sheet_world();
    plan_step(world);
    CHECK_FALSE(world.scene.plan.pins_move);
    world.scene.script.pin_targets.set(4, Vec3(0, 1, 0));  // not pinned
    plan_step(world);
    CHECK_FALSE(world.scene.plan.pins_move);
    world.scene.script.free[4] = 0.0;
    plan_step(world);
    CHECK(world.scene.plan.pins_move);
}

TEST_CASE("A plan is made anew when the scene has changed, and only motion is updated in between") {
    World world = sheet_world();
    REQUIRE(step(world).ok());
    CHECK_FALSE(world.scene.plan.pins);
    world.scene.script.free[2] = 0.0;
    world.scene.script.pin_targets.set(2, world.state.cloth.positions.at(2) + Vec3(0, 1e-3, 0));
    REQUIRE(step(world).ok());
    CHECK_FALSE(world.scene.plan.pins_move);  // the scene was not marked as changed
    scene_changed(world);
    world.scene.script.pin_targets.set(2, world.state.cloth.positions.at(2) + Vec3(0, 1e-3, 0));
    REQUIRE(step(world).ok());
    CHECK(world.scene.plan.pins_move);
    REQUIRE(step(world).ok());
    CHECK_FALSE(world.scene.plan.pins_move);
}

TEST_CASE("The plan of a simulation holds counts, skips and predictions and runs nothing") {
    World world = sheet_world();
    const ScenePlan plan = scene_plan(world.scene, world.state.cloth, {});
    CHECK(plan.vertices == 20);
    CHECK(plan.springs.total() == static_cast<int>(world.scene.model.springs.size()));
    CHECK(plan.scheme == Scheme::backward_euler);
    CHECK(plan.memory_bytes > 1e4);
    CHECK(plan.evaluations_a_step > 1.0);
    CHECK_FALSE(plan.skipped.empty());
    CHECK(world.state.time == 0.0);
    CHECK(world.plan_outdated);
}

TEST_CASE("With skipping off the run ends in the same state as with it") {
    for (const bool plane : {false, true}) {
        for (const double damping : {0.0, 0.1}) {
            for (const Vec3& gravity : {Vec3(0, -9.81, 0), Vec3(0, 0, 0)}) {
                CAPTURE(plane, damping, gravity.y());
                Fabric fabric = sheet_fabric();
                fabric.spring_damping = damping;
                int iterations = 0;
                const auto skipping = end_of_run({.gravity = gravity}, fabric, plane, iterations);
                const auto everything = end_of_run({.skip = false, .gravity = gravity}, fabric, plane, iterations);
                CHECK(iterations > 0);
                CHECK(largest_difference(skipping, everything) < 1e-4);
            }
        }
    }
}

TEST_CASE("A detector without obstacles is used only if nothing is skipped") {
    for (const bool skip : {true, false}) {
        World world = sheet_world(sheet_fabric(), {.skip = skip});
        auto detector = std::make_unique<PlaneDetector>();
        PlaneDetector& plane = *detector;
        world.scene.detector = std::move(detector);
        world.scene.detector->set_cloth(world.scene.model.triangles, world.scene.model.thickness);
        for (int n = 0; n < 3; ++n) CHECK(step(world).ok());
        CHECK(plane.candidate_updates == (skip ? 0 : 3));
    }
}

TEST_CASE("Where every vertex is pinned and nothing moves a step solves nothing") {
    World world = sheet_world(sheet_fabric(), {.measure = StepMeasures::all});
    for (int i = 0; i < 20; ++i) world.scene.script.free[i] = 0.0;
    world.state.cloth.velocities.set(7, Vec3(0, 1, 0));
    const std::vector<Vec3> before = world.state.cloth.points;
    const StepReport report = step(world);
    CHECK(report.ok());
    CHECK(report.newton_iterations == 0);
    CHECK(report.largest_speed == 0.0);
    CHECK(world.state.cloth.points == before);
    CHECK(world.work.newton.current.points.empty());
    world.scene.script.pin_targets.set(3, before[3] + Vec3(0, 0.01, 0));
    CHECK(step(world).ok());
    CHECK(world.state.cloth.positions.at(3) == before[3] + Vec3(0, 0.01, 0));
}

TEST_CASE("A plan made again from its part in a saved state is the same in every field") {
    const auto check = [](World& world, const auto& script) {
        for (int n = 0; n < 4; ++n) {
            script(n);
            step(world);
            REQUIRE_FALSE(world.plan_outdated);
            CHECK(plan_again(world.scene, world.state.cloth, world.scene.plan) == world.scene.plan);
        }
    };
    const auto nothing = [](int) {};
    for (const Scheme scheme : {Scheme::backward_euler, Scheme::rk4, Scheme::tr_bdf2, Scheme::automatic}) {
        for (const bool skip : {true, false}) {
            World free = sheet_world(sheet_fabric(), {.time_step = 1e-3, .scheme = scheme, .skip = skip, .wind = Vec3(1, 0, 0)});
            check(free, nothing);
        }
    }
    Fabric bending = sheet_fabric();
    bending.springs.bend = 0.0;
    bending.bend_stiffness = 1e-3;
    World held = sheet_world(bending, {.measure = StepMeasures::ledger});
    held.scene.script.free[0] = 0.0;
    held.scene.script.pin_targets = held.state.cloth.positions;
    check(held, [&](int n) {
        held.scene.script.pin_targets.set(0, held.state.cloth.positions.at(0) + Vec3(0, n % 2 == 0 ? 1e-3 : 0.0, 0));
    });
    World plane = sheet_world();
    add_plane(plane);
    check(plane, [&](int n) { plane.scene.script.obstacles[0].end.translation = Vec3(0, 0, n < 2 ? 1e-3 * n : 1e-3); });
}

}  // namespace percale::test::planning_test
