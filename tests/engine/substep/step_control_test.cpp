#include "engine/substep/step_control.h"

#include <cmath>
#include <limits>

#include "engine/tolerances.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::step_control_test {
namespace {

struct Covered {
    double error = 0.0;  // m, of all accepted steps
    double last = 0.0;   // s
    int accepted = 0, rejected = 0;
};

/// Steps over `time` where a step of length dt at t has the error rate(t) dt^(order + 1).
template <class Rate>
Covered cover(double time, double tolerance, int order, Rate rate) {
    StepControl control;
    Covered covered;
    for (double t = 0.0; t < time - 1e-12;) {
        const double length = next_length(control, time - t);
        const double error = rate(t) * std::pow(length, order + 1);
        if (!accept_attempt({length, error, order, false}, tolerance, control)) {
            ++covered.rejected;
            continue;
        }
        covered.error += error;
        covered.last = length;
        ++covered.accepted;
        t += length;
    }
    return covered;
}

}  // namespace

TEST_CASE("The errors of accepted steps add up to slightly less than the tolerance, whatever the order") {
    for (const int order : {1, 2, 4}) {
        for (const double tolerance : {1e-2, 1e-4}) {
            const Covered covered = cover(1.0, tolerance, order, [](double t) { return 5.0 + 100.0 * t; });
            CAPTURE(order, tolerance, covered.accepted, covered.rejected);
            CHECK(covered.error < tolerance);
            CHECK(covered.error > 0.1 * tolerance);
            CHECK(covered.rejected <= covered.accepted / 10 + 2);
        }
    }
}

TEST_CASE("Steps with too large an error are rejected and tried shorter") {
    StepControl control{.length = 0.01};
    CHECK_FALSE(accept_attempt({0.01, 1.0, 2, false}, 1e-3, control));
    CHECK(control.length == Approx(0.002));
    CHECK_FALSE(accept_attempt({0.002, std::numeric_limits<double>::quiet_NaN(), 2, false}, 1e-3, control));
    CHECK(control.length == Approx(0.0004));
    CHECK(accept_attempt({0.0004, 0.0, 2, false}, 1e-3, control));
    CHECK(control.length <= 0.0004);
    CHECK(accept_attempt({0.0004, 0.0, 2, false}, 1e-3, control));
    CHECK(control.length == Approx(0.0008));
}

TEST_CASE("An impact, whose error falls with the length only, uses the left allowance and is passed") {
    // A jump of velocity by 1 m/s between 0.4 and 0.401 s costs dt/2 m.
    const Covered covered = cover(1.0, 1e-2, 1, [](double t) { return t > 0.4 && t < 0.40001 ? 1e9 : 1.0; });
    CHECK(covered.accepted < 2000);
    CHECK(covered.error < 1.1e-2);
}

TEST_CASE("Steps in contact pass a jump whose error no length reduces enough, and never get shorter than the shortest") {
    StepControl control{.length = 0.01};
    const double jump = 1.0, tolerance = 1e-3;  // m/s, m
    double length = 0.01;
    int attempts = 0;
    while (!accept_attempt({length, jump * length, 2, true}, tolerance, control)) {
        length = next_length(control, 1.0);
        ++attempts;
    }
    CHECK(attempts < 20);
    CHECK(jump * length < 0.01 * tolerance);
    for (int n = 0; n < 50; ++n) accept_attempt({control.length, 1.0, 2, false}, tolerance, control);
    CHECK(control.length >= shortest_step);
    CHECK(control.missed);
    CHECK(accept_attempt({shortest_step, 0.0, 2, false}, tolerance, control));
    CHECK_FALSE(control.missed);
}

TEST_CASE("The remaining time is divided evenly") {
    CHECK(next_length({.length = 0.3}, 1.0) == 0.25);
    CHECK(next_length({.length = 0.25}, 1.0) == 0.25);
    CHECK(next_length({.length = 2.0}, 1.0) == 1.0);
    CHECK(next_length({}, 1.0) == Approx(5e-5));
}

TEST_CASE("The size of an error is the worst cloth's mean by mass, held vertices left out") {
    World world = make_world(linked_masses({0.1, 0.3}, {{0, 1, 1.0, 10.0, 0.0}}), {Vec3(0, 0, 0), Vec3(1, 0, 0)}, {});
    const Vec3Arrays error = to_vec3_arrays({Vec3(3, 0, 0), Vec3(0, 4, 0)});
    CHECK(mean_size(world.scene, error) == Approx(std::sqrt((0.1 * 9.0 + 0.3 * 16.0) / 0.4)));
    world.scene.script.free[1] = 0.0;
    CHECK(mean_size(world.scene, error) == Approx(std::sqrt(0.1 * 9.0 / 0.4)));
}

}  // namespace percale::test::step_control_test
