#include <cmath>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test {
namespace {

constexpr double m1 = 0.2, m2 = 0.5, rest = 1.0;
constexpr double reduced = m1 * m2 / (m1 + m2);

SolverScene pair_of_masses(double stretch, double stiffness, double damping, const StepSettings& settings) {
    return solver_scene(linked_masses({m1, m2}, {{0, 1, rest, stiffness, damping}}), {Vec3(rest + stretch, 0, 0), Vec3::Zero()},
                        settings);
}

Vec3 span(const SolverScene& scene) { return scene.state.positions.at(0) - scene.state.positions.at(1); }

}  // namespace

TEST_CASE("A damped pair follows the damped oscillator while its centre falls freely") {
    const double k = 40.0;
    for (const double zeta : {0.0, 0.1, 0.5}) {
        const double damping = zeta * 2.0 * std::sqrt(k * reduced), omega = std::sqrt(k / reduced);
        SolverScene scene =
            pair_of_masses(0.3, k, damping, {.time_step = 1e-3, .scheme = Scheme::rk4, .gravity = Vec3(0, 0, -9.81)});
        // Gravity acts across the pair, so it stays on its line and falls.
        const double turned = omega * std::sqrt(1.0 - zeta * zeta), decay = zeta * omega;
        for (int n = 1; n <= 1000; ++n) {
            scene.step();
            if (n % 100 != 0) continue;
            const double t = 1e-3 * n;
            const double u = 0.3 * std::exp(-decay * t) * (std::cos(turned * t) + decay / turned * std::sin(turned * t));
            CAPTURE(zeta, t);
            CHECK(span(scene).norm() - rest == Approx(u).margin(1e-8));
            const Vec3 centre = (m1 * scene.state.positions.at(0) + m2 * scene.state.positions.at(1)) / (m1 + m2);
            CHECK((centre - Vec3(m1 * (rest + 0.3) / (m1 + m2), 0, -0.5 * 9.81 * t * t)).norm() < 1e-11);
        }
    }
}

TEST_CASE("Damping leaves the rigid rotation of a pair alone") {
    const double k = 40.0, spin = 5.0;
    const double length = k * rest / (k - reduced * spin * spin);  // where the spring gives the centripetal force
    for (const double damping : {0.0, 3.0}) {
        SolverScene scene =
            pair_of_masses(length - rest, k, damping, {.time_step = 1e-3, .scheme = Scheme::rk4, .gravity = Vec3::Zero()});
        scene.state.velocities.set(0, Vec3(0, 0, spin * length * m2 / (m1 + m2)));
        scene.state.velocities.set(1, Vec3(0, 0, -spin * length * m1 / (m1 + m2)));
        for (int n = 0; n < 5000; ++n) scene.step();
        CHECK(span(scene).norm() == Approx(length).epsilon(1e-8));
        const Vec3 rate = scene.state.velocities.at(0) - scene.state.velocities.at(1);
        CHECK(rate.norm() == Approx(spin * length).epsilon(1e-8));
        CHECK(std::atan2(span(scene).z(), span(scene).x()) ==
              Approx(std::remainder(spin * 5.0, 2.0 * std::numbers::pi)).epsilon(1e-6));
    }
}

TEST_CASE("Symplectic Euler keeps a spinning pair's angular momentum, backward Euler loses it") {
    const double k = 400.0, spin = 5.0;
    const double length = k * rest / (k - reduced * spin * spin);
    const auto momentum_kept = [&](Scheme scheme) {
        SolverScene scene = pair_of_masses(
            length - rest, k, 0.0, {.time_step = 0.01, .scheme = scheme, .newton_tolerance = 1e-12, .gravity = Vec3::Zero()});
        scene.state.velocities.set(0, Vec3(0, 0, spin * length * m2 / (m1 + m2)));
        scene.state.velocities.set(1, Vec3(0, 0, -spin * length * m1 / (m1 + m2)));
        for (int n = 0; n < 200; ++n) scene.step();
        const Vec3 rate = scene.state.velocities.at(0) - scene.state.velocities.at(1);
        return span(scene).cross(rate).norm() / (spin * length * length);
    };
    CHECK(momentum_kept(Scheme::symplectic_euler) == Approx(1.0).epsilon(1e-12));
    CHECK(momentum_kept(Scheme::backward_euler) < 0.95);
}

TEST_CASE("A hanging rope of N equal links stretches by m g N (N + 1) / (2 k)") {
    const double m = 0.05, k = 300.0, link = 0.1;
    for (const int links : {1, 5, 20}) {
        std::vector<Link> list;
        std::vector<Vec3> places = {Vec3::Zero()};
        for (int i = 0; i < links; ++i) {
            list.push_back({i, i + 1, link, k, 0.1});
            places.emplace_back(0.0, -link * (i + 1), 0.0);
        }
        const StepSettings settings{.time_step = 0.2, .newton_tolerance = 1e-12};
        SolverScene scene = solver_scene(linked_masses(std::vector<double>(links + 1, m), list), places, settings);
        scene.pin(0);
        for (int n = 0; n < 400; ++n) scene.step();
        const double stretch = -scene.state.positions.y[links] - links * link;
        CHECK(stretch == Approx(m * 9.81 * links * (links + 1) / (2.0 * k)).epsilon(1e-7));
    }
}

TEST_CASE("A pendulum on a stiff link has the period of the elliptic integral") {
    // Released from 90 degrees: T/T0 = (2/pi) K(sin 45 degrees) = 1.1803405990.
    const double length = 1.0, k = 1e5;
    SolverScene scene = solver_scene(linked_masses({1.0, 0.1}, {{0, 1, length, k, 0.0}}), {Vec3::Zero(), Vec3(length, 0, 0)},
                                     {.time_step = 1e-4, .scheme = Scheme::rk4});
    scene.pin(0);
    double before = 1.0, quarter = 0.0;
    for (int n = 1; quarter == 0.0 && n < 20000; ++n) {
        scene.step();
        const double x = scene.state.positions.x[1];
        if (x <= 0.0) quarter = 1e-4 * (n - 1 + before / (before - x));
        before = x;
    }
    const double small_swing = 2.0 * std::numbers::pi * std::sqrt(length / 9.81);
    CHECK(4.0 * quarter / small_swing == Approx(1.1803405990).epsilon(1e-4));
}

}  // namespace percale::test
