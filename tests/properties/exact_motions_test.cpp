#include <cmath>
#include <numbers>

#include "engine/schemes/schemes.h"
#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"
#include "tests/support/reference_table.h"

namespace percale::test::exact_motions_test {
namespace {

constexpr double m1 = 0.2, m2 = 0.5, rest = 1.0;
constexpr double reduced = m1 * m2 / (m1 + m2);

SolverScene pair_of_masses(double stretch, double stiffness, double damping, const StepSettings& settings) {
    return solver_scene(linked_masses({m1, m2}, {{0, 1, rest, stiffness, damping}}), {Vec3(rest + stretch, 0, 0), Vec3::Zero()},
                        settings);
}

Vec3 span(const SolverScene& scene) { return scene.state.positions.at(0) - scene.state.positions.at(1); }

/// Links whose ends are in general positions, with random velocities.
World thrown_links(const StepSettings& settings, double damping) {
    Random random(17);
    std::vector<Link> links = random_links(random, 8, 16);
    for (Link& link : links) link.damping = damping;
    for (Link& link : links) link.stiffness = 50.0;
    const std::vector<double> masses(8, 0.1);
    World world = make_world(linked_masses(masses, links), random_points(random, 8, 1.0), settings);
    world.state.cloth.velocities = to_vec3_arrays(random_points(random, 8, 1.0));
    return world;
}

Vec3 centre(const World& world) {
    Vec3 sum = Vec3::Zero();
    double mass = 0.0;
    for (int i = 0; i < world.scene.model.vertex_count(); ++i) {
        sum += world.scene.model.mass[i] * world.state.cloth.positions.at(i);
        mass += world.scene.model.mass[i];
    }
    return sum / mass;
}

/// A pair that spins as a rigid body, its spring giving the centripetal force.
struct SpinningPair {
    static constexpr double k = 400.0, spin = 5.0, length = k * rest / (k - reduced * spin * spin);
    SolverScene scene;

    SpinningPair(double damping, const StepSettings& settings) : scene(pair_of_masses(length - rest, k, damping, settings)) {
        scene.state.velocities.set(0, Vec3(0, 0, spin * length * m2 / (m1 + m2)));
        scene.state.velocities.set(1, Vec3(0, 0, -spin * length * m1 / (m1 + m2)));
    }
    /// Ratio to the angular momentum at the start.
    double momentum() const {
        const Vec3 rate = scene.state.velocities.at(0) - scene.state.velocities.at(1);
        return span(scene).cross(rate).norm() / (spin * length * length);
    }
};

}  // namespace

TEST_CASE("A damped pair follows the damped oscillator while its centre falls freely", "[law]") {
    const double k = 40.0;
    double worst = 0.0, worst_centre = 0.0;
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
            worst = std::max(worst, std::abs(span(scene).norm() - rest - u));
            const Vec3 middle = (m1 * scene.state.positions.at(0) + m2 * scene.state.positions.at(1)) / (m1 + m2);
            const Vec3 exact(m1 * (rest + 0.3) / (m1 + m2), 0, -0.5 * 9.81 * t * t);
            worst_centre = std::max(worst_centre, (middle - exact).norm());
        }
    }
    check_law("damped pair, RK4: distance from the damped oscillator, m", worst, 1e-8);
    check_law("damped pair, RK4: distance of its centre from free fall, m", worst_centre, 1e-11);
}

TEST_CASE("Cloth with damped springs falls as cloth with undamped ones, in every scheme", "[law]") {
    for (const Scheme scheme : all_schemes) {
        const StepSettings settings{.time_step = 2e-3, .scheme = scheme, .newton_tolerance = 1e-10, .newton_iterations = 200};
        World clean = thrown_links(settings, 0.0), rusty = thrown_links(settings, 1.0);
        for (int n = 0; n < 200; ++n) REQUIRE((step(clean).ok() && step(rusty).ok()));
        const double apart = (clean.state.cloth.positions.at(0) - rusty.state.cloth.positions.at(0)).norm();
        CHECK(apart > 0.01);  // the damping had an effect
        check_law("rusty springs fall as clean ones, " + std::string(facts_of(scheme).word) + ": centres apart, m",
                  (centre(clean) - centre(rusty)).norm(), 1e-11);
    }
}

TEST_CASE("Ether drag, which this engine does not have, would slow down both fall and rotation", "[law]") {
    // Symplectic Euler with -c v on every vertex instead of damping along the spring.
    const double drag = 0.05, dt = 1e-3;
    SpinningPair pair(0.0, {.time_step = dt, .scheme = Scheme::symplectic_euler});
    const double start = (m1 * pair.scene.state.positions.y[0] + m2 * pair.scene.state.positions.y[1]) / (m1 + m2);
    for (int n = 0; n < 1000; ++n) {
        for (const auto& [vertex, mass] : {std::pair(0, m1), std::pair(1, m2)}) {
            pair.scene.state.velocities.add(vertex, -dt * drag / mass * pair.scene.state.velocities.at(vertex));
        }
        pair.scene.step();
    }
    const double end = (m1 * pair.scene.state.positions.y[0] + m2 * pair.scene.state.positions.y[1]) / (m1 + m2);
    check_law_between("with ether drag a pair would fall in 1 s, of free fall", (start - end) / (0.5 * 9.81), 0.5, 0.97);
    check_law_between("with ether drag a spinning pair would keep in 1 s, of its angular momentum", pair.momentum(), 0.5, 0.97);
}

TEST_CASE("Damping leaves the rigid rotation of a pair alone", "[law]") {
    double worst = 0.0, worst_angle = 0.0;
    for (const double damping : {0.0, 3.0}) {
        SpinningPair pair(damping, {.time_step = 1e-3, .scheme = Scheme::rk4, .gravity = Vec3::Zero()});
        for (int n = 0; n < 5000; ++n) pair.scene.step();
        const Vec3 x = span(pair.scene);
        const double angle = std::remainder(SpinningPair::spin * 5.0, 2.0 * std::numbers::pi);
        worst = std::max({worst, std::abs(x.norm() - SpinningPair::length), std::abs(pair.momentum() - 1.0)});
        worst_angle = std::max(worst_angle, std::abs(std::atan2(x.z(), x.x()) - angle));
    }
    check_law("spinning pair with and without damping, RK4, 5 s: change of length (m) and angular momentum", worst, 1e-8);
    check_law("spinning pair with and without damping, RK4, 5 s: angle, rad", worst_angle, 1e-6);
}

TEST_CASE("Symplectic Euler keeps a spinning pair's angular momentum, backward Euler loses about half in seconds", "[law]") {
    const auto momentum_kept = [&](Scheme scheme) {
        SpinningPair pair(0.0, {.time_step = 1.0 / 60.0, .scheme = scheme, .newton_tolerance = 1e-12, .gravity = Vec3::Zero()});
        for (int n = 0; n < 240; ++n) pair.scene.step();
        return pair.momentum();
    };
    check_law("spinning pair, symplectic Euler, 4 s: change of angular momentum",
              std::abs(momentum_kept(Scheme::symplectic_euler) - 1.0), 1e-12);
    check_law_between("spinning pair, backward Euler at 1/60 s, 4 s: angular momentum left",
                      momentum_kept(Scheme::backward_euler), 0.2, 0.7);
}

TEST_CASE("A hanging rope of N equal links stretches by m g N (N + 1) / (2 k)", "[law]") {
    double worst = 0.0;
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
        worst = std::max(worst, std::abs(stretch / (m * 9.81 * links * (links + 1) / (2.0 * k)) - 1.0));
    }
    check_law("rope of 1, 5, 20 links: relative error of its stretch", worst, 1e-7);
}

TEST_CASE("A pendulum on a stiff link has the period of the elliptic integral", "[law]") {
    const double length = 1.0, k = 1e5, small_swing = 2.0 * std::numbers::pi * std::sqrt(length / 9.81);
    double worst = 0.0;
    for (const std::vector<double>& row : reference_table("pendulum.csv")) {
        if (row[0] != 30.0 && row[0] != 90.0 && row[0] != 150.0) continue;
        const double angle = row[0] * std::numbers::pi / 180.0;
        SolverScene scene = solver_scene(linked_masses({1.0, 0.1}, {{0, 1, length, k, 0.0}}),
                                         {Vec3::Zero(), length * Vec3(std::sin(angle), -std::cos(angle), 0)},
                                         {.time_step = 2e-4, .scheme = Scheme::rk4});
        scene.pin(0);
        double before = 1.0, quarter = 0.0;
        for (int n = 1; quarter == 0.0 && n < 20000; ++n) {
            scene.step();
            const double x = scene.state.positions.x[1];
            if (x <= 0.0) quarter = 2e-4 * (n - 1 + before / (before - x));
            before = x;
        }
        worst = std::max(worst, std::abs(4.0 * quarter / small_swing / row[1] - 1.0));
    }
    check_law("pendulum from 30, 90, 150 degrees: relative error of the period", worst, 1e-4);
}

TEST_CASE("A short chain swings in its lowest mode with the first zero of the Laguerre polynomial", "[law]") {
    const int links = 3;
    const double m = 0.1, link = 0.2, k = 2e4, dt = 2e-4;
    std::vector<Link> list;
    std::vector<Vec3> places = {Vec3::Zero()};
    for (int i = 0; i < links; ++i) list.push_back({i, i + 1, link, k, 0.0});
    // The chain hangs, stretched by the weight below, and is displaced in its mode: z_i = L_i(omega^2 l/g) counted from the free
    // end.
    double exact = 0.0;
    for (const std::vector<double>& row : reference_table("chain_modes.csv")) {
        if (row[0] == links && row[1] == 1) exact = row[2];
    }
    const double u = exact * exact;
    const double shape[] = {0.0, 1.0 - 2.0 * u + 0.5 * u * u, 1.0 - u, 1.0};
    for (int i = 0; i < links; ++i) {
        places.emplace_back(0.0, places.back().y() - link - m * 9.81 * (links - i) / k, 1e-3 * shape[i + 1]);
    }
    SolverScene scene =
        solver_scene(linked_masses(std::vector<double>(links + 1, m), list), places, {.time_step = dt, .scheme = Scheme::rk4});
    scene.pin(0);
    double before = 1.0, quarter = 0.0;
    for (int n = 1; quarter == 0.0 && n < 20000; ++n) {
        scene.step();
        const double z = scene.state.positions.z[links];
        if (z <= 0.0) quarter = dt * (n - 1 + before / (before - z));
        before = z;
    }
    const double omega = 0.5 * std::numbers::pi / quarter;
    check_law("chain of 3 links, lowest mode by RK4: relative error of its frequency",
              std::abs(omega * std::sqrt(link / 9.81) / exact - 1.0), 1e-3);
}

}  // namespace percale::test::exact_motions_test
