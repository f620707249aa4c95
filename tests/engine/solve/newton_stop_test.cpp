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
    Vectors start = to_vectors({Vec3(1, 0, 0), Vec3(0, 0, 0)}), foreseen = to_vectors({Vec3(1, 0, 3), Vec3(0, 4, 0)});

    Pair() { free[0] = free[1] = 1.0; }
    TimeError error(bool foresees) const {
        return {.compute = &compute,
                .model = &model,
                .free = &free,
                .dt = 0.1,
                .start = &start,
                .foreseen = foresees ? &foreseen : nullptr,
                .foreseen_share = 0.5};
    }
};

/// Whether a Newton step of size `change` m at both vertices is small.
bool small(const Pair& pair, double change, bool foresees, double share, double allowance = 1e300) {
    TimeError error = pair.error(foresees);
    error.allowance = allowance;
    const Vec3 dv(change / error.dt, 0, 0);
    const Vectors direction = to_vectors({dv, dv}), residual = to_vectors({-0.2 * dv, -0.3 * dv});
    const Vectors ahead = to_vectors({Vec3(1, 0, 2), Vec3(0, 2, 0)});
    return change_is_small(error, {residual, direction, ahead}, share, pair.model.bodies[0]);
}

}  // namespace

TEST_CASE("The time error is that of backward Euler, or what was not foreseen where that is less") {
    Pair pair;
    const Vectors v = to_vectors({Vec3(1, 0, 2), Vec3(0, 2, 0)});
    const double change = 0.2 * 4.0 + 0.3 * 4.0, unforeseen = 0.25 * (0.2 * 1.0 + 0.3 * 4.0);
    CHECK(squared_error(pair.error(false), 0, 2, v) == Approx(change));
    CHECK(squared_error(pair.error(true), 0, 2, v) == Approx(unforeseen));
    CHECK(squared_error(pair.error(true), 0, 2, pair.start) == 0.0);
    CHECK(time_error(pair.error(false), v) == Approx(0.05 * std::sqrt(change / 0.5)));
    pair.free[1] = 0.0;
    CHECK(squared_error(pair.error(false), 0, 2, v) == Approx(0.2 * 4.0));
}

TEST_CASE("A change is small below its share of the time error, of the least length, and of the allowance") {
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
    const Vectors v = to_vectors({Vec3(1, 0, 2), Vec3(0, 2, 0)});
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

TEST_CASE("Linear solves are as exact as Newton's share asks, and no looser than at a share of 1") {
    const Pair pair;
    const Vectors v = to_vectors({Vec3(1, 0, 2), Vec3(0, 2, 0)});
    const auto accuracy = [&](double share, bool adaptive) {
        StepSettings settings{.newton_share = share};
        settings.adaptive = adaptive;
        return solve_target(pair.error(false), {1, 0.5, 0.5}, settings, v).relative_gain;
    };
    CHECK(accuracy(0.1, false) == Approx(0.02));
    CHECK(accuracy(5.0, false) == Approx(0.2));
    CHECK(accuracy(1.0, true) == Approx(0.05));
}

}  // namespace percale::test::newton_stop_test
