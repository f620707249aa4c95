#include "engine/substep/explicit_substep.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::explicit_substep_test {

TEST_CASE("The error of adaptive explicit steps is nearly the true one of their two halves") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::midpoint, Scheme::rk4}) {
        const StepSettings settings{.time_step = 2e-3, .adaptive = true, .scheme = scheme};
        World world = mass_on_spring(settings), exact = mass_on_spring({.time_step = 2e-3, .scheme = Scheme::rk4});
        const double estimated = advance_world(world, {0.0, 1.0}).error;
        for (int n = 0; n < 200; ++n) advance_world(exact, {n / 200.0, (n + 1) / 200.0});
        const double error =
            (world.state.cloth.positions.at(1) - exact.state.cloth.positions.at(1)).norm() * std::sqrt(0.2 / 0.3);
        CAPTURE(static_cast<int>(scheme), error);
        CHECK(estimated > 0.5 * error);
        CHECK(estimated < 4.0 * error);
    }
}

}  // namespace percale::test::explicit_substep_test
