#include "engine/schemes/schemes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>

#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::schemes_test {
namespace {

constexpr double k = 40.0, m1 = 0.2, m2 = 0.3, rest = 1.0;
const double omega = std::sqrt(k * (m1 + m2) / (m1 * m2));

/// One step of two masses on a spring along x, from stretch u and rate of stretch v, as a linear map of (u, v/omega).
Eigen::Vector2d step_pair(Scheme scheme, double a, const Eigen::Vector2d& start) {
    StepSettings settings{.time_step = a / omega, .scheme = scheme, .newton_tolerance = 1e-13, .gravity = Vec3::Zero()};
    World world =
        make_world(linked_masses({m1, m2}, {{0, 1, rest, k, 0.0}}), {Vec3(rest + start[0], 0, 0), Vec3::Zero()}, settings);
    world.state.cloth.velocities.set(0, Vec3(start[1] * omega, 0, 0));
    step(world);
    const double length = world.state.cloth.positions.x[0] - world.state.cloth.positions.x[1];
    return {length - rest, (world.state.cloth.velocities.x[0] - world.state.cloth.velocities.x[1]) / omega};
}

/// The eigenvalue of a step with the largest size: growth and phase per step.
std::complex<double> amplification(Scheme scheme, double a) {
    constexpr double size = 0.01;
    Eigen::Matrix2d map;
    map.col(0) = step_pair(scheme, a, {size, 0.0}) / size;
    map.col(1) = step_pair(scheme, a, {0.0, size}) / size;
    const auto values = map.eigenvalues();
    const std::complex<double> larger = std::abs(values[0]) > std::abs(values[1]) ? values[0] : values[1];
    return {larger.real(), std::abs(larger.imag())};
}

}  // namespace

TEST_CASE("The table has one entry a scheme, in the order of the enum, named as in scene files") {
    const auto options = step_options();
    const auto scheme =
        std::find_if(options.begin(), options.end(), [](const Option<StepSettings>& o) { return o.key == "scheme"; });
    REQUIRE(scheme != options.end());
    REQUIRE(scheme->choices.size() == all_schemes.size() + 1);
    CHECK(scheme->choices.back() == "auto");
    CHECK(scheme_table().size() == all_schemes.size());
    for (std::size_t i = 0; i < all_schemes.size(); ++i) {
        CHECK(static_cast<std::size_t>(all_schemes[i]) == i);
        const SchemeFacts& facts = facts_of(all_schemes[i]);
        CHECK(facts.scheme == all_schemes[i]);
        CHECK(facts.word == scheme->choices[i]);
        CHECK(facts.implicit == (facts.force_evaluations == 0));
        CHECK(facts.implicit == (facts.stages > 0));
        CHECK_FALSE(facts.stability.empty());
    }
}

TEST_CASE("The stages of a step make one step, and in schemes of second order forces act in its middle on average") {
    for (const Scheme scheme : all_schemes) {
        double weight = 0.0, place = 0.0;
        for (const StageWeight& stage : stage_weights(scheme)) {
            weight += stage.weight;
            place += stage.weight * stage.place;
        }
        CAPTURE(facts_of(scheme).word);
        CHECK(weight == Approx(1.0).epsilon(1e-15));
        // BDF2 evaluates forces at its end alone and compensates by the previous step.
        const bool at_end = scheme == Scheme::backward_euler || scheme == Scheme::bdf2;
        CHECK(place == Approx(at_end ? 1.0 : 0.5).epsilon(1e-15));
    }
}

TEST_CASE("Symplectic Euler keeps the amplitude and turns by 2 asin(a/2) a step", "[law]") {
    for (const double a : {0.1, 0.5, 1.0, 1.9}) {
        const std::complex<double> r = amplification(Scheme::symplectic_euler, a);
        CHECK(std::abs(r) == Approx(1.0).epsilon(1e-12));
        CHECK(std::arg(r) == Approx(2.0 * std::asin(a / 2.0)).epsilon(1e-9));
    }
}

TEST_CASE("RK4 turns and damps by the exponential series to fourth order", "[law]") {
    for (const double a : {0.1, 0.5, 1.0, 2.5}) {
        const std::complex<double> z(0.0, a), r = amplification(Scheme::rk4, a);
        const std::complex<double> expected = 1.0 + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0;
        CHECK(std::abs(r) == Approx(std::abs(expected)).epsilon(1e-11));
        CHECK(r.real() == Approx(expected.real()).epsilon(1e-10).margin(1e-11));
    }
}

TEST_CASE("Backward Euler damps by 1/sqrt(1 + a^2) and turns by atan(a) a step, at every a", "[law]") {
    for (const double a : {0.1, 0.5, 1.0, 10.0, 1000.0}) {
        const std::complex<double> r = amplification(Scheme::backward_euler, a);
        CHECK(std::abs(r) == Approx(1.0 / std::sqrt(1.0 + a * a)).epsilon(1e-6));
        CHECK(std::arg(r) == Approx(std::atan(a)).epsilon(1e-6));
    }
}

TEST_CASE("Forward Euler grows by sqrt(1 + a^2), the explicit midpoint by sqrt(1 + a^4/4) a step", "[law]") {
    for (const double a : {0.1, 0.5, 1.0, 1.9}) {
        CHECK(std::abs(amplification(Scheme::forward_euler, a)) == Approx(std::sqrt(1.0 + a * a)).epsilon(1e-10));
        CHECK(std::abs(amplification(Scheme::midpoint, a)) == Approx(std::sqrt(1.0 + a * a * a * a / 4.0)).epsilon(1e-10));
    }
}

TEST_CASE("Trapezoid and implicit midpoint keep the amplitude and turn by 2 atan(a/2) a step", "[law]") {
    for (const Scheme scheme : {Scheme::trapezoid, Scheme::implicit_midpoint}) {
        for (const double a : {0.1, 0.5, 1.0, 10.0}) {
            const std::complex<double> r = amplification(scheme, a);
            CAPTURE(static_cast<int>(scheme), a);
            CHECK(std::abs(r) == Approx(1.0).epsilon(1e-7));
            CHECK(std::arg(r) == Approx(2.0 * std::atan(a / 2.0)).epsilon(1e-6));
        }
    }
}

TEST_CASE("TR-BDF2 amplifies by (1 + (1 - 2h') z) / (1 - h' z)^2, which vanishes for large a", "[law]") {
    const double h = 1.0 - std::sqrt(0.5);
    for (const double a : {0.1, 0.5, 1.0, 10.0, 30.0}) {
        const std::complex<double> z(0.0, a), r = amplification(Scheme::tr_bdf2, a);
        const std::complex<double> expected = (1.0 + (1.0 - 2.0 * h) * z) / ((1.0 - h * z) * (1.0 - h * z));
        CAPTURE(a);
        CHECK(std::abs(r) == Approx(std::abs(expected)).epsilon(1e-6));
        CHECK(r.real() == Approx(expected.real()).epsilon(1e-6).margin(1e-7));
    }
}

TEST_CASE("Each scheme is stable up to the limit of the table and not beyond", "[law]") {
    for (const Scheme scheme : all_schemes) {
        const SchemeFacts& facts = facts_of(scheme);
        CAPTURE(facts.word);
        for (double a = 0.05; a < std::min(20.0, 0.999 * facts.stable_up_to); a *= 1.3) {
            CHECK(std::abs(amplification(facts.scheme, a)) <= 1.0 + (facts.implicit ? 1e-7 : 1e-11));
        }
        if (facts.implicit) continue;
        if (facts.stable_up_to == 0.0) {
            CHECK(std::abs(amplification(facts.scheme, 0.2)) > 1.0 + 1e-4);
            continue;
        }
        CHECK(std::abs(amplification(facts.scheme, 0.999 * facts.stable_up_to)) <= 1.0 + 1e-11);
        CHECK(std::abs(amplification(facts.scheme, 1.001 * facts.stable_up_to)) > 1.0 + 1e-4);
    }
}

}  // namespace percale::test::schemes_test
