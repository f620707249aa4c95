#include "engine/step/step_parts.h"

#include <atomic>
#include <cmath>

#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::step_parts_test {
namespace {

/// A sheet at rest on a plane, one corner held above it.
struct RestingSheet {
    Simulation simulation;
    ClothId cloth;
    ObstacleId plane;
    Vec3 corner = Vec3::Zero();

    explicit RestingSheet(const StepSettings& settings = {}, int steps = 20)
        : simulation(settings, std::make_unique<PlaneDetector>()) {
        cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric(), {.translation = Vec3(0, 0.01, 0)}, "towel");
        plane = simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.3, .name = "floor"});
        simulation.pin(cloth, 0);
        for (int n = 0; n < steps; ++n) REQUIRE(simulation.step().ok());
        corner = simulation.positions(cloth)[0];
    }
    /// 0.95 m to the side: 10 parts of less than 0.1 m.
    void aim(double fraction) {
        const Vec3 way(0.95, 0.0, 0.0), target = corner + way;
        simulation.move_obstacle(plane, {.translation = fraction * way});
        simulation.move_pin(cloth, 0, fraction == 1.0 ? target : Vec3(corner + fraction * (target - corner)));
    }
};

}  // namespace

TEST_CASE("A step in which an obstacle moves far does the same as many short ones, bit for bit") {
    const StepSettings settings{.measure = StepMeasures::ledger};
    RestingSheet far(settings), by_hand(settings);
    far.aim(1.0);
    const double start = far.simulation.time();
    const StepReport report = far.simulation.step();
    REQUIRE(report.ok());
    CHECK(report.parts == 10);
    CHECK(report.dt == Approx(1.0 / 60.0));
    CHECK(report.smallest_dt == Approx(1.0 / 600.0));
    CHECK(report.time == far.simulation.time());
    CHECK(far.simulation.time() == Approx(start + 1.0 / 60.0).epsilon(1e-15));
    CHECK(far.simulation.obstacle_pose(far.plane).translation == Vec3(0.95, 0.0, 0.0));
    CHECK(far.simulation.positions(far.cloth)[0] == far.corner + Vec3(0.95, 0.0, 0.0));

    by_hand.simulation.set_time_step(1.0 / 60.0 / 10);
    int newton = 0;
    double work = 0.0, rubbed = 0.0, time_error = 0.0;
    for (int part = 1; part <= 10; ++part) {
        by_hand.aim(part == 10 ? 1.0 : part / 10.0);
        const StepReport short_one = by_hand.simulation.step();
        REQUIRE(short_one.ok());
        newton += short_one.newton_iterations;
        time_error += short_one.time_error;
        work += short_one.energy.work;
        rubbed += short_one.energy.dissipated_friction;
    }
    CHECK(far.simulation.state_hash() == by_hand.simulation.state_hash());
    CHECK(report.newton_iterations == newton);
    CHECK(report.time_error == Approx(time_error));
    CHECK(report.jump == Approx(0.95).epsilon(0.01));
    CHECK(report.energy.work == Approx(work));
    CHECK(report.energy.dissipated_friction == Approx(rubbed));
    CHECK(report.energy.closure() < 1e-6);
}

TEST_CASE("Where a part fails, all parts are undone") {
    const StepSettings settings{.measure = StepMeasures::all};
    RestingSheet scene(settings), other(settings);
    // The plane first moves away, so that it meets the pinned corner only after some parts of its way back.
    other.simulation.move_obstacle(other.plane, {.translation = Vec3(0.0, -1.0, 0.0)});
    REQUIRE(other.simulation.step().parts == 10);
    scene.simulation.move_obstacle(scene.plane, {.translation = Vec3(0.0, -1.0, 0.0)});
    REQUIRE(scene.simulation.step().parts == 10);
    const std::uint64_t hash = scene.simulation.state_hash();
    const double time = scene.simulation.time();
    scene.simulation.move_obstacle(scene.plane, {.translation = Vec3(0.0, 0.5, 0.0)});
    const StepReport report = scene.simulation.step();
    CHECK(report.status == StepStatus::obstacle_too_fast);
    CHECK(report.parts > 5);
    CHECK(report.jump == Approx(1.5).epsilon(0.05));
    CHECK(report.dt == 1.0 / 60.0);
    CHECK(report.energy.total() == Approx(scene.simulation.energy().total()));
    CHECK(report.time == scene.simulation.time());
    CHECK(scene.simulation.time() == time);
    CHECK(scene.simulation.state_hash() == hash);
    CHECK(scene.simulation.obstacle_pose(scene.plane).translation == Vec3(0.0, -1.0, 0.0));
    for (RestingSheet* either : {&scene, &other}) {  // no trace of it influences later steps
        either->simulation.move_obstacle(either->plane, {.translation = Vec3(0.0, -0.5, 0.0)});
        for (int n = 0; n < 5; ++n) CHECK(either->simulation.step().ok());
    }
    CHECK(scene.simulation.state_hash() == other.simulation.state_hash());
}

TEST_CASE("A pin that goes with an obstacle which turns keeps its place on it in every part, and another moves straight") {
    const TriangleMesh sheet = make_grid(0.4, 0.4, 5, 5);
    World world = make_world(cloth_model(sheet, sheet_fabric()), sheet.vertices, {});
    const Pose start{.translation = Vec3(0, -0.5, 0)};
    const Pose end{.translation = Vec3(0.1, -0.5, 0), .rotation = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0}};
    world.scene.script.obstacles = {{"wheel", start, end}};
    world.scene.script.free[0] = world.scene.script.free[4] = 0.0;
    const Vec3 other = world.state.cloth.positions.at(4) + Vec3(0, 0, 0.3);
    world.scene.script.pin_targets.set(0, transform(end, world.state.cloth.positions.at(0) - start.translation));
    world.scene.script.pin_targets.set(4, other);
    const auto arrive = [](World& now) {
        ObstacleState& wheel = now.scene.script.obstacles[0];
        const Vec3 place(-0.2, 0.5, -0.2);  // of the sheet's corner, in the frame of the wheel
        CHECK((now.scene.script.pin_targets.at(0) - transform(wheel.end, place)).norm() < 1e-12);
        CHECK(now.scene.script.pin_targets.at(4).x() == 0.2);
        wheel.start = wheel.end;
        return StepReport{};
    };
    CHECK(step_in_parts(world, 6, arrive).parts == 6);
    CHECK(world.scene.script.pin_targets.at(4) == other);
}

TEST_CASE("An obstacle that jumps farther than cloth can follow fails the step at once and is reported") {
    RestingSheet scene;
    const std::uint64_t hash = scene.simulation.state_hash();
    scene.simulation.move_obstacle(scene.plane, {.translation = Vec3(50.0, 0.0, 0.0)});
    const StepReport report = scene.simulation.step();
    CHECK(report.status == StepStatus::obstacle_too_fast);
    CHECK(report.newton_iterations == 0);
    CHECK(report.travel == Approx(50.0).epsilon(1e-3));
    CHECK(mentions(report.explanation(), {"floor", "moves 50 m beside the cloth in one step", "teleport"}));
    CHECK(scene.simulation.state_hash() == hash);
    CHECK(scene.simulation.obstacle_pose(scene.plane).translation == Vec3::Zero());
}

TEST_CASE("An obstacle that turns or moves a few parts far in a step did not jump") {
    RestingSheet scene;
    scene.simulation.move_obstacle(scene.plane, {.rotation = {std::cos(1.2), 0.0, std::sin(1.2), 0.0}});  // 137 degrees about y
    const StepReport turn = scene.simulation.step();
    CHECK(turn.parts >= 8);
    CHECK(turn.jump == 0.0);
    RestingSheet other;
    other.simulation.move_obstacle(other.plane, {.translation = Vec3(0.3, 0.0, 0.0)});
    const StepReport slow = other.simulation.step();
    CHECK(slow.parts > 1);
    CHECK(slow.jump == 0.0);
}

TEST_CASE("A pin that jumps farther than cloth with contact can follow fails the step at once, too") {
    RestingSheet scene;
    const std::uint64_t hash = scene.simulation.state_hash();
    scene.simulation.move_pin(scene.cloth, 0, scene.corner + Vec3(0.0, 30.0, 0.0));
    const StepReport report = scene.simulation.step();
    CHECK(report.status == StepStatus::pin_blocked);
    CHECK(report.newton_iterations == 0);
    CHECK(mentions(report.explanation(), {"pinned vertex 0 of cloth 0 (towel) moves 30", "teleport"}));
    CHECK(scene.simulation.state_hash() == hash);
    scene.simulation.move_pin(scene.cloth, 0, scene.corner + Vec3(0.0, 0.95, 0.0));
    CHECK(scene.simulation.step().parts == 3);
    // Without contact, cloth may be pulled at any speed.
    Simulation free(StepSettings{});
    const ClothId cloth = free.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
    free.pin(cloth, 0);
    free.move_pin(cloth, 0, free.positions(cloth)[0] + Vec3(0.0, 30.0, 0.0));
    CHECK(free.step().parts == 1);
}

TEST_CASE("The limit of work may be changed during a run") {
    RestingSheet scene;
    scene.simulation.move_pin(scene.cloth, 0, scene.corner + Vec3(0.0, 0.05, 0.0));
    scene.simulation.set_work_limit(1);
    CHECK(scene.simulation.step().status == StepStatus::work_limit);
    CHECK(mentions(scene_error([&] { scene.simulation.set_work_limit(-1); }), {"set_work_limit", "work_limit = -1"}));
    scene.simulation.set_work_limit(0);
    CHECK(scene.simulation.step().ok());
}

TEST_CASE("A step that takes more Newton iterations than work_limit fails and leaves every bit, in parts as in one") {
    for (const double way : {0.0, 1.0}) {
        CAPTURE(way);
        RestingSheet free, limited({.work_limit = 2}, 0);
        limited.simulation.restore(free.simulation.save());  // the limit is no part of a state
        for (RestingSheet* scene : {&limited, &free}) {
            scene->simulation.move_obstacle(scene->plane, {.translation = Vec3(way, 0.0, 0.0)});
            scene->simulation.move_pin(scene->cloth, 0, free.corner + Vec3(0.0, 0.5, 0.0));
        }
        const std::uint64_t hash = limited.simulation.state_hash();
        CHECK(free.simulation.step().newton_iterations > 3);
        const StepReport report = limited.simulation.step();
        CHECK(report.status == StepStatus::work_limit);
        CHECK(report.newton_iterations <= 2);
        CHECK(mentions(report.explanation(), {"work_limit", "Newton iterations"}));
        CHECK(limited.simulation.state_hash() == hash);
    }
}

namespace {

void check_cancelled(Simulation& simulation) {
    std::atomic<bool> cancel = true;
    simulation.set_cancel(&cancel);
    const std::uint64_t hash = simulation.state_hash();
    const double time = simulation.time();
    const StepReport report = simulation.step();
    CHECK(report.status == StepStatus::cancelled);
    CHECK(mentions(report.explanation(), {"cancelled"}));
    CHECK(simulation.state_hash() == hash);
    CHECK(simulation.time() == time);
    cancel = false;
    CHECK(simulation.step().ok());
    CHECK(simulation.state_hash() != hash);
    simulation.set_cancel(nullptr);
}

}  // namespace

TEST_CASE("A cancelled step fails and leaves every bit, by any scheme, in parts as in one, and the next one continues") {
    for (const StepSettings& settings :
         {StepSettings{}, StepSettings{.adaptive = true}, StepSettings{.scheme = Scheme::tr_bdf2}}) {
        for (const bool far : {false, true}) {
            RestingSheet scene(settings);
            if (far) scene.aim(1.0);
            check_cancelled(scene.simulation);
        }
    }
    Simulation falling({.time_step = 1e-4, .scheme = Scheme::symplectic_euler});
    falling.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
    check_cancelled(falling);
}

}  // namespace percale::test::step_parts_test
