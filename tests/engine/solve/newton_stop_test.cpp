#include "engine/solve/newton_stop.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::newton_stop_test {
namespace {

/// Two masses, the second of which may be held.
struct Pair {
    ClothModel model = linked_masses({0.2, 0.3}, {{0, 1, 1.0, 10.0, 0.0}});
    AlignedVector<double> free = AlignedVector<double>(16, 0.0);
    Vec3Arrays start = to_vec3_arrays({Vec3(1, 0, 0), Vec3(0, 0, 0)}),
               extrapolated = to_vec3_arrays({Vec3(1, 0, 3), Vec3(0, 4, 0)});

    Pair() { free[0] = free[1] = 1.0; }
    TimeError error(bool extrapolates) const {
        return {.compute = &compute,
                .model = &model,
                .free = &free,
                .dt = 0.1,
                .start = &start,
                .extrapolated = extrapolates ? &extrapolated : nullptr,
                .extrapolated_error_ratio = 0.5};
    }
};

/// Whether a Newton step of size `change` m at both vertices is small.
bool small(const Pair& pair, double change, bool extrapolates, double error_ratio, double allowance = 1e300) {
    TimeError error = pair.error(extrapolates);
    error.allowance = allowance;
    const Vec3 dv(change / error.dt, 0, 0);
    const Vec3Arrays direction = to_vec3_arrays({dv, dv}), residual = to_vec3_arrays({-0.2 * dv, -0.3 * dv});
    const Vec3Arrays ahead = to_vec3_arrays({Vec3(1, 0, 2), Vec3(0, 2, 0)});
    return change_is_small(error, {residual, direction, ahead}, error_ratio, pair.model.bodies[0]);
}

}  // namespace

TEST_CASE("The time error is that of backward Euler, or the error of the extrapolation where that is less") {
    Pair pair;
    const Vec3Arrays v = to_vec3_arrays({Vec3(1, 0, 2), Vec3(0, 2, 0)});
    const double change = 0.2 * 4.0 + 0.3 * 4.0, extrapolation_error = 0.25 * (0.2 * 1.0 + 0.3 * 4.0);
    CHECK(squared_error(pair.error(false), 0, 2, v) == Approx(change));
    CHECK(squared_error(pair.error(true), 0, 2, v) == Approx(extrapolation_error));
    CHECK(squared_error(pair.error(true), 0, 2, pair.start) == 0.0);
    CHECK(time_error(pair.error(false), v) == Approx(0.05 * std::sqrt(change / 0.5)));
    pair.free[1] = 0.0;
    CHECK(squared_error(pair.error(false), 0, 2, v) == Approx(0.2 * 4.0));
}

TEST_CASE("A change is small below its fraction of the time error, of the smallest length, and of the allowance") {
    const Pair pair;
    const double error = 0.05 * 2.0;  // of both vertices
    CHECK(small(pair, 0.24 * error, false, 0.25));
    CHECK_FALSE(small(pair, 0.26 * error, false, 0.25));
    CHECK_FALSE(small(pair, 0.24 * error, true, 0.25));
    CHECK(small(pair, 0.9e-7, false, 0.0));
    CHECK_FALSE(small(pair, 1.1e-7, false, 0.0));
    CHECK_FALSE(small(pair, 0.9e-7, false, 0.0, 1e-7));
    CHECK(small(pair, 0.9e-8, false, 0.0, 1e-7));
}

TEST_CASE("With a residual to reach the linear residual follows Newton's, else the gain counts") {
    const Pair pair;
    const Vec3Arrays v = to_vec3_arrays({Vec3(1, 0, 2), Vec3(0, 2, 0)});
    const StepSettings residual{.newton_tolerance = 1e-8}, gain{};
    CHECK(solve_target(pair.error(false), {0, 1.0, 1.0}, residual, v).relative_residual == 0.1);
    CHECK(solve_target(pair.error(false), {2, 0.1, 1e-3}, residual, v).relative_residual == Approx(0.009));
    CHECK(solve_target(pair.error(false), {2, 0.1, 2e-8}, residual, v).relative_residual == Approx(0.15));
    const SolveTarget first = solve_target(pair.error(false), {0, 1.0, 1.0}, gain, v);
    const SolveTarget later = solve_target(pair.error(false), {1, 0.5, 0.5}, gain, v);
    CHECK(first.absolute_gain == 0.0);
    CHECK(later.absolute_gain == Approx(0.2 * 0.2 * 2.0));
    CHECK(later.relative_gain == 0.2);
}

TEST_CASE("Linear solves are as exact as Newton's error ratio asks, and no looser than at a ratio of 1") {
    const Pair pair;
    const Vec3Arrays v = to_vec3_arrays({Vec3(1, 0, 2), Vec3(0, 2, 0)});
    const auto accuracy = [&](double error_ratio, bool adaptive) {
        StepSettings settings{.newton_error_ratio = error_ratio};
        settings.adaptive = adaptive;
        return solve_target(pair.error(false), {1, 0.5, 0.5}, settings, v).relative_gain;
    };
    CHECK(accuracy(0.1, false) == Approx(0.02));
    CHECK(accuracy(5.0, false) == Approx(0.2));
    CHECK(accuracy(1.0, true) == Approx(0.05));
}

}  // namespace percale::test::newton_stop_test
