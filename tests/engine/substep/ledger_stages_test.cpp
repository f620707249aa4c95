#include "engine/substep/ledger.h"

#include <cmath>

#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::ledger_stages_test {
namespace {

/// Springs in free motion, one end of which is prescribed.
World thrown_links(Scheme scheme, double damping) {
    Random random(17);
    std::vector<Link> links = random_links(random, 8, 16);
    for (Link& link : links) link.stiffness = 50.0;
    for (Link& link : links) link.damping = damping;
    const std::vector<double> masses(8, 0.1);
    const std::vector<Vec3> places = random_points(random, 8, 1.0), velocities = random_points(random, 8, 1.0);
    World world =
        make_world(linked_masses(masses, links), places, {.time_step = 1e-3, .scheme = scheme, .measure = StepMeasures::ledger});
    world.state.cloth.velocities = to_vec3_arrays(velocities);
    return world;
}

constexpr Scheme explicit_ones[] = {Scheme::forward_euler, Scheme::symplectic_euler, Scheme::midpoint, Scheme::rk4};

}  // namespace

TEST_CASE("An explicit scheme's account of a step is exact, with moving pins") {
    for (const Scheme scheme : explicit_ones) {
        World world = thrown_links(scheme, 0.5);
        world.scene.script.free[3] = 0.0;
        world.state.cloth.velocities.set(3, Vec3::Zero());
        for (int n = 0; n < 20; ++n) {
            world.scene.script.pin_targets.set(3, world.state.cloth.positions.at(3) + 1e-3 * Vec3(1.0, -0.5 * n, 0.3));
            const StepEnergy energy = step(world).energy;
            CAPTURE(static_cast<int>(scheme), n, energy.imbalance);
            CHECK(energy.closure() < 1e-13);
            CHECK(energy.work != 0.0);
            CHECK(energy.residual_work == 0.0);
        }
    }
}

TEST_CASE("Free vertices get the momentum of the stage forces") {
    for (const Scheme scheme : explicit_ones) {
        World world = thrown_links(scheme, 0.5);
        for (int n = 0; n < 20; ++n) {
            const Vec3Arrays before = world.state.cloth.velocities;
            REQUIRE(step(world).ok());
            for (int i = 0; i < 8; ++i) {
                const Vec3 change = world.state.cloth.velocities.at(i) - before.at(i);
                CHECK((world.scene.model.mass[i] * change - world.work.impulse.at(i)).norm() < 1e-14);
            }
        }
    }
}

TEST_CASE("RK4's own loss in a step falls at least with the fifth power of its length") {
    double before = 0.0;
    for (const double dt : {8e-3, 4e-3, 2e-3}) {
        World world = thrown_links(Scheme::rk4, 0.0);
        world.scene.settings.time_step = dt;
        const StepEnergy energy = step(world).energy;
        CHECK(energy.dissipated_material == 0.0);
        CAPTURE(dt, energy.dissipated_integrator);
        if (before != 0.0) CHECK(before / std::abs(energy.dissipated_integrator) > 25.0);
        before = std::abs(energy.dissipated_integrator);
    }
}

TEST_CASE("An implicit scheme's account of a step is exact, with moving pins and adaptive steps") {
    for (const Scheme scheme : {Scheme::implicit_midpoint, Scheme::trapezoid, Scheme::bdf2, Scheme::tr_bdf2}) {
        for (const bool adaptive : {false, true}) {
            World world = thrown_links(scheme, 0.5);
            world.scene.settings.time_step = 0.01;
            world.scene.settings.adaptive = adaptive;
            world.scene.settings.tolerance = 1e-2;
            world.scene.script.free[3] = 0.0;
            world.state.cloth.velocities.set(3, Vec3::Zero());
            int parts = 0;
            for (int n = 0; n < 20; ++n) {
                world.scene.script.pin_targets.set(3, world.state.cloth.positions.at(3) + 1e-2 * Vec3(1.0, -0.1 * n, 0.3));
                const StepReport report = step(world);
                REQUIRE(report.ok());
                parts = std::max(parts, report.parts);
                CAPTURE(static_cast<int>(scheme), adaptive, n, report.energy.imbalance);
                CHECK(report.energy.closure() < 1e-13);
                CHECK(report.energy.work != 0.0);
            }
            CHECK((parts > 1) == adaptive);
        }
    }
}

TEST_CASE("Implicit midpoint and trapezoid dissipate nothing of a linear oscillator") {
    for (const Scheme scheme : {Scheme::implicit_midpoint, Scheme::trapezoid}) {
        World world = make_world(linked_masses({1.0, 2.0}, {{0, 1, 1.0, 50.0, 0.0}}), {Vec3(1.2, 0, 0), Vec3::Zero()},
                                 {.time_step = 0.02,
                                  .scheme = scheme,
                                  .newton_tolerance = 1e-12,
                                  .measure = StepMeasures::ledger,
                                  .gravity = Vec3::Zero()});
        double lost = 0.0;
        for (int n = 0; n < 50; ++n) lost = std::max(lost, std::abs(step(world).energy.dissipated_integrator));
        CHECK(lost < 1e-12);
    }
}

}  // namespace percale::test::ledger_stages_test
