#include "engine/solve/line_search.h"

#include <limits>

#include "tests/support/catch.h"

namespace percale::test::line_search_test {
namespace {

/// A quadratic along the line: objective a/2 (t - t0)^2.
LineTrial quadratic(double a, double t0, double t) {
    return {.start_objective = 0.5 * a * t0 * t0,
            .start_slope = -a * t0,
            .objective = 0.5 * a * (t - t0) * (t - t0),
            .slope = a * (t - t0)};
}

}  // namespace

TEST_CASE("A trial that lowers the objective enough is accepted") {
    CHECK(accept_trial(1.0, quadratic(3.0, 1.0, 1.0)));
    CHECK(accept_trial(1.9, quadratic(3.0, 1.0, 1.9)));
    CHECK_FALSE(accept_trial(2.1, quadratic(3.0, 1.0, 2.1)));
}

TEST_CASE("Armijo's rule asks for a ten-thousandth of the decrease that the slope predicts") {
    LineTrial trial{.start_objective = 1.0, .start_slope = -2.0, .objective = 1.0 - 1.9e-4, .slope = 5.0};
    CHECK_FALSE(accept_trial(1.0, trial));
    trial.objective = 1.0 - 2.1e-4;
    CHECK(accept_trial(1.0, trial));
    CHECK_FALSE(accept_trial(2.0, trial));
}

TEST_CASE("Where the objective rises by no more than rounding the slope decides") {
    LineTrial trial{.start_objective = 1e6, .start_slope = -1e-9, .objective = 1e6 + 1e-7, .slope = 0.5e-9};
    CHECK(accept_trial(1.0, trial));
    trial.slope = 1e-9;
    CHECK_FALSE(accept_trial(1.0, trial));
    trial.slope = 0.5e-9;
    trial.objective = 1e6 + 1.0;  // a rise beyond rounding
    CHECK_FALSE(accept_trial(1.0, trial));
}

TEST_CASE("Where the objective is not known the slope decides, up to 0.9 of the first one") {
    LineTrial trial{.start_objective = 1.0, .start_slope = -2.0, .objective = 5.0, .slope = 1.7, .objective_known = false};
    CHECK(accept_trial(1.0, trial));
    trial.objective = 0.0;
    trial.slope = 1.9;
    CHECK_FALSE(accept_trial(1.0, trial));
    trial.slope = -3.0;  // before the minimum no slope is too steep
    CHECK(accept_trial(1.0, trial));
}

TEST_CASE("A trial that is not finite is rejected") {
    for (const double bad : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        LineTrial trial = quadratic(1.0, 1.0, 1.0);
        trial.objective = bad;
        CHECK_FALSE(accept_trial(1.0, trial));
        trial = quadratic(1.0, 1.0, 1.0);
        trial.slope = bad;
        CHECK_FALSE(accept_trial(1.0, trial));
        CHECK(shorten(trial) == 0.5);
    }
}

TEST_CASE("Shortening goes to the zero of a linear slope, within limits") {
    for (const double t0 : {0.2, 0.37, 0.55}) CHECK(shorten(quadratic(2.0, t0, 1.0)) == Approx(t0).epsilon(1e-14));
    CHECK(shorten(quadratic(2.0, 0.01, 1.0)) == 0.15);
    CHECK(shorten(quadratic(2.0, 0.9, 1.0)) == 0.6);
    CHECK(shorten({.start_objective = 0, .start_slope = -1.0, .objective = 0, .slope = -2.0}) == 0.5);
}

}  // namespace percale::test::line_search_test
