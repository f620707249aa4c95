// The longest stable step of the explicit schemes, found by bisection on cloth whose modes are known.
#include <cmath>
#include <numbers>

#include "engine/plan/scheme_choice.h"
#include "engine/schemes/schemes.h"
#include "engine/step/step.h"
#include "percale/stability.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

namespace percale::test::explicit_limits_test {
namespace {

constexpr int links = 6;  // of a chain along x, its ends held
constexpr double mass = 0.02, stiffness = 300.0, rest = 0.1;

/// Frequency of the chain's fastest longitudinal mode: 2 sqrt(k/m) sin(pi n/(2 (n + 1))), n = links - 1 masses.
double fastest() { return 2.0 * std::sqrt(stiffness / mass) * std::sin(0.5 * std::numbers::pi * (links - 1) / links); }

/// Springs damped in proportion to their stiffness, so that the fastest mode has the damping ratio zeta.
World chain(Scheme scheme, double zeta, double dt) {
    const double damping = stiffness * 2.0 * zeta / fastest();
    std::vector<Link> springs;
    std::vector<Vec3> positions;
    for (int i = 0; i <= links; ++i) positions.emplace_back(rest * i, 0.0, 0.0);
    for (int i = 0; i < links; ++i) springs.push_back({i, i + 1, rest, stiffness, damping});
    return linked_world(linked_masses(std::vector<double>(links + 1, mass), springs), positions, {0, links},
                        {.time_step = dt, .scheme = scheme, .measure = StepMeasures::all, .gravity = Vec3::Zero()});
}

/// Whether small velocities in all modes grow tenfold.
bool grows(Scheme scheme, double zeta, double dt) {
    World world = chain(scheme, zeta, dt);
    for (int i = 1; i < links; ++i) world.state.cloth.velocities.set(i, Vec3(1e-9 * std::sin(2.9 * i * i + 1.0), 0, 0));
    for (int n = 0; n < 3000; ++n) {
        const StepReport report = step(world);
        if (!report.ok() || report.largest_speed > 1e-8) return true;
    }
    return false;
}

double measured_limit(Scheme scheme, double zeta) {
    double inside = 0.02 * zeta / fastest(), outside = 4.0 / fastest();
    while (outside > 1.005 * inside) {
        const double middle = std::sqrt(inside * outside);
        (grows(scheme, zeta, middle) ? outside : inside) = middle;
    }
    return std::sqrt(inside * outside);
}

}  // namespace

TEST_CASE("The measured longest stable step of explicit schemes is that of the theory", "[law]") {
    for (const Scheme scheme : {Scheme::forward_euler, Scheme::symplectic_euler, Scheme::midpoint, Scheme::rk4}) {
        for (const double zeta : {0.2, 2.0}) {
            const double omega = fastest();
            const double theory = longest_stable_step(scheme, {omega * omega, 2.0 * zeta * omega});
            check_law("chain, " + std::string(facts_of(scheme).word) + ", damping ratio " + figure(zeta) +
                          ": relative error of the longest stable step",
                      std::abs(measured_limit(scheme, zeta) / theory - 1.0), 0.02);
        }
    }
}

TEST_CASE("The predicted limit of explicit schemes is the measured one, damping included", "[law]") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4}) {
        for (const double zeta : {0.2, 2.0}) {
            const World hung = chain(scheme, zeta, 1e-3);
            check_law("chain, " + std::string(facts_of(scheme).word) + ", damping ratio " + figure(zeta) +
                          ": relative error of the step that warnings go by",
                      std::abs(stable_step(hung.scene, hung.state.cloth, scheme) / measured_limit(scheme, zeta) - 1.0), 0.05);
        }
    }
}

}  // namespace percale::test::explicit_limits_test
