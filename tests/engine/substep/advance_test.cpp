#include "engine/substep/advance.h"

#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::advance_test {
namespace {

World moving_sheet(Scheme scheme, bool over_plane) {
    TriangleMesh grid = make_grid(0.2, 0.2, 5, 5);
    for (Vec3& x : grid.vertices) x.y() += 0.006;
    const bool implicit = scheme == Scheme::backward_euler || scheme >= Scheme::implicit_midpoint;
    World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices,
                             {.time_step = implicit ? 1.0 / 120.0 : 1e-4, .scheme = scheme, .measure = StepMeasures::ledger});
    if (over_plane) add_plane(world);
    Random random(2);
    for (int i = 0; i < 25; ++i) world.state.cloth.velocities.set(i, random.point(0.3));
    for (int n = 0; n < 3; ++n) REQUIRE(step(world).ok());
    plan_step(world);
    return world;
}

}  // namespace

TEST_CASE("A substep is a function of its values: its start stays, and solved twice it ends in the same bits") {
    for (const Scheme scheme : all_schemes) {
        const bool takes_contact = scheme == Scheme::backward_euler || scheme == Scheme::tr_bdf2;
        for (const bool over_plane : {false, takes_contact}) {
            CAPTURE(static_cast<int>(scheme), over_plane);
            World world = moving_sheet(scheme, over_plane);
            const StepState start = world.state;
            StepState first, second;
            const Substep substep{world.scene, start.cloth.positions, {0.0, 1.0}};
            const SubstepResult one = advance(substep, world.state, world.work, first);
            const SubstepResult other = advance(substep, world.state, world.work, second);
            REQUIRE(one.end == SubstepOutcome::solved);
            REQUIRE(other.end == SubstepOutcome::solved);
            CHECK(same_bits(world.state.cloth.positions, start.cloth.positions));
            CHECK(same_bits(world.state.cloth.velocities, start.cloth.velocities));
            CHECK(same_bits(first.cloth.positions, second.cloth.positions));
            CHECK(same_bits(first.cloth.velocities, second.cloth.velocities));
            CHECK(first.contact_energy == second.contact_energy);
            CHECK(one.flows.work == other.flows.work);
            CHECK(one.flows.dissipated_integrator == other.flows.dissipated_integrator);
        }
    }
}

TEST_CASE("A substep that is not solved states why") {
    World world = moving_sheet(Scheme::backward_euler, true);
    StepState end;
    world.scene.settings.newton_tolerance = 1e-14;
    world.scene.settings.newton_iterations = 2;
    const Substep hasty{world.scene, world.state.cloth.positions, {0.0, 1.0}};
    CHECK(advance(hasty, world.state, world.work, end).end == SubstepOutcome::not_converged);
    world.scene.settings = {.measure = StepMeasures::ledger};
    world.scene.script.free[12] = 0.0;
    world.scene.script.pin_targets.set(12, world.state.cloth.positions.at(12) - Vec3(0.0, 0.1, 0.0));
    plan_step(world);
    const Substep blocked{world.scene, world.state.cloth.positions, {0.0, 1.0}};
    CHECK(advance(blocked, world.state, world.work, end).end == SubstepOutcome::blocked);
}

}  // namespace percale::test::advance_test
