#include "engine/substep/state_forces.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::state_forces_test {

TEST_CASE("Accelerations are f/m, and 0 at held vertices") {
    World world = mass_on_spring({.scheme = Scheme::rk4});
    world.state.cloth.velocities.set(1, Vec3(2.0, 0, 0));
    Vec3Arrays accelerations;
    set_accelerations(world.scene, {world.state.cloth.positions, world.state.cloth.velocities, world.state.cloth.positions, {}},
                      world.work, accelerations);
    CHECK(accelerations.at(0) == Vec3::Zero());
    CHECK((accelerations.at(1) - Vec3(-(50.0 * 0.2 + 0.3 * 2.0) / 0.2, -9.81, 0.0)).norm() < 1e-12);
}

TEST_CASE("The work of a moving pin is the gain of energy, to the order of the step") {
    const auto excess = [](double dt) {
        World world = mass_on_spring({.time_step = dt, .scheme = Scheme::rk4, .measure = StepMeasures::all});
        world.scene.model.springs.damping.assign(1, 0.0);
        finish_model(world.scene.model);
        double work = 0.0;
        const auto energy = [&] {
            const double stretch = (world.state.cloth.positions.at(0) - world.state.cloth.positions.at(1)).norm() - 1.0;
            double sum = 0.5 * 50.0 * stretch * stretch;
            for (int i = 0; i < 2; ++i) {
                sum += world.scene.model.mass[i] *
                       (0.5 * world.state.cloth.velocities.at(i).squaredNorm() + 9.81 * world.state.cloth.positions.y[i]);
            }
            return sum;
        };
        const double before = energy();
        for (int n = 0; n < std::lround(0.1 / dt); ++n) {
            world.scene.script.pin_targets.set(0, world.state.cloth.positions.at(0) + dt * Vec3(-0.5, 0.2, 0.0));
            plan_step(world);
            const ClothState start = world.state.cloth;
            advance_world(world, {0.0, 1.0});
            const auto [pins, wind] = script_work(world.scene, start, world.state.cloth, dt, world.work);
            work += pins + wind;
        }
        return std::abs(energy() - before - work);
    };
    const double coarse = excess(1e-3), fine = excess(5e-4);
    CAPTURE(coarse, fine);
    CHECK(coarse < 1e-4);
    CHECK(coarse / fine > 3.0);
}

}  // namespace percale::test::state_forces_test
