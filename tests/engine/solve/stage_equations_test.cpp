#include "engine/solve/stage_equations.h"

#include "tests/support/catch.h"
#include "tests/support/one_stage.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::stage_equations_test {
namespace {

SolverScene moving_sheet() {
    SolverScene scene = solver_scene(make_grid(1.0, 1.0, 5, 5), sheet_fabric(), {});
    Random random(4);
    for (int i = 0; i < 25; ++i) scene.state.positions.add(i, random.point(0.02));
    for (int i = 0; i < 25; ++i) scene.state.velocities.set(i, random.point(1.0));
    update_points(scene.state);
    scene.targets = scene.state.positions;
    return scene;
}

}  // namespace

TEST_CASE("The prediction continues with the old velocities, prescribed vertices to their targets") {
    OneStage one(moving_sheet());
    SolverScene& scene = one.scene;
    scene.pin(3);
    scene.plan.pins_move = true;
    scene.targets.set(3, scene.before.positions.at(3) + Vec3(0.0, 0.01, 0.0));
    const ImplicitStage stage = one.stage();
    const StageSearch search(stage, one.warm_start, scene);
    CHECK_FALSE(search.equations.arrived(scene.newton.trial));  // the start
    CHECK(search.equations.arrived(scene.newton.current));
    const double dt = scene.settings.time_step;
    for (int i = 0; i < 25; ++i) {
        const Vec3 end = i == 3 ? scene.targets.at(3) : Vec3(scene.before.positions.at(i) + dt * scene.before.velocities.at(i));
        CHECK((scene.newton.current.positions.at(i) - end).norm() < 1e-15);
    }
}

TEST_CASE("A residual is the gradient of the objective, 0 where vertices are prescribed") {
    OneStage one(moving_sheet());
    one.scene.pin(7);
    const ImplicitStage stage = one.stage();
    NewtonSpace& space = one.scene.newton;
    StageSearch search(stage, one.warm_start, one.scene);
    search.evaluate();
    CHECK(space.current.residual.at(7) == Vec3::Zero());
    const auto objective = [&](int vertex, const Vec3& change) {
        space.direction.velocity.resize(25);
        space.direction.velocity.set(vertex, change);
        search.go(1.0);
        return space.trial.objective;
    };
    for (const int vertex : {0, 6, 12, 24}) {
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 step = 1e-4 * Vec3::Unit(axis);
            const double slope = (objective(vertex, step) - objective(vertex, -step)) / 2e-4;
            CHECK(slope == Approx(space.current.residual.at(vertex)[axis]).epsilon(1e-5).margin(1e-8));
        }
    }
}

TEST_CASE("A move is clamped before it crosses, and velocities with it") {
    OneStage one(sheet_on_plane(0.0, 0.3, 0.05));
    for (int i = 0; i < 16; ++i) one.scene.before.velocities.set(i, Vec3(0.0, -10.0, 0.0));
    const ImplicitStage stage = one.stage();
    NewtonSpace& space = one.scene.newton;
    const StageSearch search(stage, one.warm_start, one.scene);
    const double kept = search.equations.smallest_fraction();
    CHECK(kept > 0.1);
    CHECK(kept < 0.05 * 60.0 / 10.0);
    for (int i = 0; i < 16; ++i) {
        CHECK(space.current.positions.y[i] > 0.0);
        CHECK(space.current.velocities.y[i] == Approx(-10.0 * kept));
    }
}

}  // namespace percale::test::stage_equations_test
