#include "engine/step/failure.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::failure_test {
namespace {

/// Nine vertices, the fifth pinned and not where it should be, near two obstacles that push against each other.
struct Stuck {
    World world = make_world(cloth_model(make_grid(1.0, 1.0, 3, 3), sheet_fabric()), make_grid(1.0, 1.0, 3, 3).vertices, {});
    StepReport report;

    Stuck() {
        world.scene.script.obstacles = {{"floor", {}, {}}, {"press", {}, {}}};
        world.scene.script.free[4] = 0.0;
        StagePoint& last = world.work.newton.current;
        last.positions = world.state.cloth.positions;
        world.work.targets = world.state.cloth.positions;
        world.work.targets.add(4, Vec3(0, 0.1, 0));
        last.constraints.obstacle = {0, 1, 1};
        last.constraints.direction = {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 1, 0)};
        last.constraints.distance = {1e-3, 2e-3, 1.5e-3};
        last.constraints.vertex.resize(3);
    }
    void fail(SubstepOutcome end) { report_failure(world.scene, end, world.work, report); }
};

}  // namespace

TEST_CASE("A pin that is left behind is named with the nearest obstacle and the one that pushes against it") {
    Stuck stuck;
    stuck.world.scene.plan.pins_move = true;
    stuck.fail(SubstepOutcome::blocked);
    CHECK(stuck.report.status == StepStatus::pin_blocked);
    CHECK(stuck.report.blocked_cloth == 0);
    CHECK(stuck.report.blocked_vertex == 4);
    CHECK(stuck.report.blocked_name == "cloth");
    CHECK(stuck.report.blocking_name == "floor");
    CHECK(stuck.report.second_obstacle == 1);
    CHECK(stuck.report.second_name == "press");
}

TEST_CASE("Moving obstacles are reported as too fast, and cloth in the way as cloth") {
    Stuck stuck;
    stuck.world.scene.plan.obstacles_move = true;
    stuck.world.work.newton.current.constraints.obstacle = {-1, 1, 1};
    stuck.fail(SubstepOutcome::not_converged);
    CHECK(stuck.report.status == StepStatus::obstacle_too_fast);
    CHECK(stuck.report.blocking_name == "cloth");
    CHECK(stuck.report.second_name == "press");
}

TEST_CASE("Cloth that is stretched between its pins and a moving body is named instead of an obstacle's speed") {
    Stuck stuck;
    stuck.world.scene.plan.obstacles_move = true;
    stuck.world.work.newton.current.constraints.obstacle = {0, -1, 0};
    stuck.fail(SubstepOutcome::blocked);
    CHECK(stuck.report.stretched_cloth == -1);
    CHECK(mentions(stuck.report.explanation(), {"moves faster"}));
    stuck.world.work.newton.current.positions.add(0, Vec3(-4.0, 0.0, 0.0));  // its springs are 0.5 m long
    stuck.fail(SubstepOutcome::blocked);
    CHECK(stuck.report.stretched_cloth == 0);
    CHECK(stuck.report.stretched_pins == 1);
    CHECK(stuck.report.stretch == Approx(8.0));
    CHECK(mentions(stuck.report.explanation(),
                   {"an edge of cloth 0 (cloth) is stretched to 9 times", "1 pinned vertices", "go along?"}));
    CHECK_FALSE(mentions(stuck.report.explanation(), {"shorter time step"}));
    stuck.world.scene.script.free[4] = 1.0;  // no vertex is held: another reason
    stuck.report = {};
    stuck.fail(SubstepOutcome::blocked);
    CHECK(stuck.report.stretched_cloth == -1);
}

TEST_CASE("A step that is accepted unsolved names the cloth that its pins hold back") {
    Stuck stuck;
    report_unsolved(stuck.world.scene, stuck.world.work, stuck.report);
    CHECK(stuck.report.status == StepStatus::not_converged);
    CHECK(stuck.report.stretched_cloth == -1);
    stuck.world.work.newton.current.positions.add(0, Vec3(-4.0, 0.0, 0.0));
    report_unsolved(stuck.world.scene, stuck.world.work, stuck.report);
    CHECK(stuck.report.stretched_cloth == 0);
    CHECK(stuck.report.stretch == Approx(8.0));
    stuck.report = {};
    stuck.world.scene.plan.pins_move = true;  // then they do not stay behind
    report_unsolved(stuck.world.scene, stuck.world.work, stuck.report);
    CHECK(stuck.report.stretched_cloth == -1);
}

TEST_CASE("A pinned vertex in the way of an obstacle is named") {
    Stuck stuck;
    stuck.world.scene.plan.obstacles_move = true;
    stuck.world.work.newton.current.constraints.obstacle = {0, -1, 0};
    stuck.world.work.newton.current.constraints.vertex[0] = {3, 4, -1, -1};
    stuck.fail(SubstepOutcome::blocked);
    CHECK(stuck.report.blocked_vertex == 4);
    CHECK(mentions(stuck.report.explanation(), {"obstacle 0 (floor) moves faster", "vertex 4 of cloth 0 (cloth)", "is pinned"}));
}

TEST_CASE("A state that is not finite names nothing") {
    Stuck stuck;
    stuck.fail(SubstepOutcome::not_finite);
    CHECK(stuck.report.status == StepStatus::not_finite);
    CHECK(stuck.report.blocking_name.empty());
}

}  // namespace percale::test::failure_test
