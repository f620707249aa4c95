#include "engine/solve/explicit_update.h"

#include <cmath>
#include <numbers>

#include "engine/schemes/schemes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::explicit_update_test {
namespace {

/// A taut string of stretched springs between two fixed ends, displaced sideways: no spring ever goes slack.
SolverScene taut_string(Scheme scheme, double time_step) {
    constexpr int count = 11;
    std::vector<Link> links;
    std::vector<Vec3> places;
    for (int i = 0; i < count; ++i) {
        const double s = static_cast<double>(i) / (count - 1);
        places.emplace_back(s, 0.1 * std::sin(std::numbers::pi * s), 0.05 * std::sin(2.0 * std::numbers::pi * s));
        if (i > 0) links.push_back({i - 1, i, 0.06, 20.0, 0.02});
    }
    const StepSettings settings{.time_step = time_step, .scheme = scheme, .newton_tolerance = 1e-11};
    SolverScene scene = solver_scene(linked_masses(std::vector<double>(count, 0.01), links), places, settings);
    scene.pin(0);
    scene.pin(count - 1);
    return scene;
}

std::vector<Vec3> string_after(Scheme scheme, double time, int steps) {
    SolverScene scene = taut_string(scheme, time / steps);
    for (int n = 0; n < steps; ++n) scene.step();
    return to_points(scene.state.positions, scene.model.vertex_count());
}

}  // namespace

TEST_CASE("Symplectic Euler falls y0 - g dt^2 n(n+1)/2, RK4 along the exact parabola") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4}) {
        // A stable step: rounding in the lengths of springs at rest must not grow.
        const StepSettings settings{.time_step = 1e-3, .scheme = scheme};
        const TriangleMesh grid = make_grid(1.0, 1.0, 4, 4);
        SolverScene scene = solver_scene(grid, sheet_fabric(), settings);
        for (int n = 1; n <= 100; ++n) {
            scene.step();
            const double t = 1e-3 * n, fall = scheme == Scheme::rk4 ? 0.5 * 9.81 * t * t : 9.81 * 1e-6 * n * (n + 1) / 2.0;
            for (int i = 0; i < 16; ++i) {
                REQUIRE((scene.state.positions.at(i) - (grid.vertices[i] - Vec3(0.0, fall, 0.0))).norm() < 1e-11);
                REQUIRE(scene.state.velocities.at(i).y() == Approx(-9.81 * t).epsilon(1e-10));
            }
        }
        CHECK(scene.state.points == to_points(scene.state.positions, 16));
    }
}

TEST_CASE("The measured order of each explicit scheme is that of the table") {
    constexpr double time = 0.2;
    const std::vector<Vec3> exact = string_after(Scheme::rk4, time, 6400);
    for (const Scheme scheme : {Scheme::forward_euler, Scheme::symplectic_euler, Scheme::midpoint, Scheme::rk4}) {
        const SchemeFacts& facts = facts_of(scheme);
        const int first = facts.order == 4 ? 50 : 200;
        double coarser = largest_difference(string_after(facts.scheme, time, first), exact);
        for (int halving = 1; halving <= 3; ++halving) {
            const double finer = largest_difference(string_after(facts.scheme, time, first << halving), exact);
            CAPTURE(facts.word, halving, coarser, finer);
            CHECK(std::log2(coarser / finer) == Approx(facts.order).margin(0.12));
            coarser = finer;
        }
    }
}

TEST_CASE("Prescribed vertices go straight to their targets and keep the speed that takes") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4}) {
        SolverScene scene = taut_string(scheme, 1e-3);
        const Vec3 target = scene.targets.at(10) + Vec3(0.002, -0.001, 0.0005);
        scene.targets.set(10, target);
        scene.step();
        CHECK(scene.state.positions.at(10) == target);
        CHECK((scene.state.velocities.at(10) - Vec3(2.0, -1.0, 0.5)).norm() < 1e-11);
        CHECK(scene.state.positions.at(0) == Vec3(0, 0, 0));
        scene.step();
        CHECK(scene.state.positions.at(10) == target);
        CHECK(scene.state.velocities.at(10) == Vec3::Zero());
    }
}

TEST_CASE("Symplectic Euler is v += dt f(x, v)/m, then x += dt v") {
    SolverScene scene = taut_string(Scheme::symplectic_euler, 1e-3);
    const SpringNetwork& springs = scene.model.springs;
    std::vector<Vec3> x = scene.state.points, v(11, Vec3::Zero());
    for (int n = 0; n < 50; ++n) {
        std::vector<Vec3> f(11, Vec3(0.0, -9.81 * 0.01, 0.0));
        for (int s = 0; s < springs.size(); ++s) {
            const int i = springs.first[s], j = springs.second[s];
            const Vec3 d = (x[i] - x[j]).normalized();
            const Vec3 pull = (20.0 * ((x[i] - x[j]).norm() - 0.06) + 0.02 * (v[i] - v[j]).dot(d)) * d;
            f[i] -= pull;
            f[j] += pull;
        }
        for (int i = 1; i < 10; ++i) v[i] += 1e-3 * f[i] / 0.01;
        for (int i = 1; i < 10; ++i) x[i] += 1e-3 * v[i];
        scene.step();
    }
    CHECK(largest_difference(x, scene.state.points) < 1e-13);
    CHECK(largest_difference(v, to_points(scene.state.velocities, 11)) < 1e-11);
}

}  // namespace percale::test::explicit_update_test
