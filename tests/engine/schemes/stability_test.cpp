#include "percale/stability.h"

#include <Eigen/Dense>
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::stability_test {
namespace {

double limit(Scheme scheme, double omega, double zeta) {
    return longest_stable_step(scheme, {.square = omega * omega, .damping = 2.0 * zeta * omega});
}

}  // namespace

TEST_CASE("Without damping symplectic Euler is stable to 2/w, RK4 to 2 sqrt 2/w, forward Euler and the midpoint never") {
    for (const double omega : {0.1, 1.0, 3e4}) {
        CHECK(limit(Scheme::symplectic_euler, omega, 0.0) * omega == Approx(2.0).epsilon(1e-12));
        CHECK(limit(Scheme::rk4, omega, 0.0) * omega == Approx(2.0 * std::sqrt(2.0)).epsilon(1e-9));
        CHECK(limit(Scheme::forward_euler, omega, 0.0) == 0.0);
        CHECK(limit(Scheme::midpoint, omega, 0.0) == 0.0);
    }
}

TEST_CASE("Damped forward Euler is stable to 2 zeta/w, and strongly damped schemes to their limit on the real axis") {
    CHECK(limit(Scheme::forward_euler, 5.0, 0.1) == Approx(0.2 / 5.0));
    CHECK(limit(Scheme::forward_euler, 5.0, 0.999) == Approx(1.998 / 5.0));
    const double zeta = 50.0, fastest = 5.0 * (zeta + std::sqrt(zeta * zeta - 1.0));
    CHECK(limit(Scheme::forward_euler, 5.0, zeta) == Approx(2.0 / fastest));
    CHECK(limit(Scheme::midpoint, 5.0, zeta) == Approx(2.0 / fastest));
    CHECK(limit(Scheme::rk4, 5.0, zeta) == Approx(2.785293563 / fastest));
    CHECK(limit(Scheme::symplectic_euler, 5.0, 1e4) == Approx(2.0 / (2.0 * 1e4 * 5.0)).epsilon(1e-6));
}

TEST_CASE("At its limit an oscillator neither grows nor decays, and with half the step it decays") {
    const double square = 7.0, damping = 1.1;
    // One step of the midpoint as a matrix: 1 + dt A + dt^2/2 A^2.
    const auto growth = [&](double dt) {
        Eigen::Matrix2d a, step;
        a << 0.0, 1.0, -square, -damping;
        step = Eigen::Matrix2d::Identity() + dt * a + 0.5 * dt * dt * a * a;
        return step.eigenvalues().cwiseAbs().maxCoeff();
    };
    const double dt = longest_stable_step(Scheme::midpoint, {square, damping});
    CHECK(growth(dt) == Approx(1.0).margin(1e-9));
    CHECK(growth(0.5 * dt) < 0.99);
    CHECK(growth(1.05 * dt) > 1.0);
}

TEST_CASE("Implicit schemes are stable at every step") {
    for (const Scheme scheme :
         {Scheme::backward_euler, Scheme::implicit_midpoint, Scheme::trapezoid, Scheme::bdf2, Scheme::tr_bdf2})
        CHECK(std::isinf(limit(scheme, 1e6, 0.0)));
}

}  // namespace percale::test::stability_test
