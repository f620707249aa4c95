#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/schemes/schemes.h"
#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

// Properties of each scheme, measured: orders, free fall, momentum.

namespace percale::test::scheme_orders_test {
namespace {

/// A taut string of stretched, damped springs between two held ends, displaced sideways: no spring ever goes slack.
World taut_string(const StepSettings& settings) {
    constexpr int count = 11;
    std::vector<Link> links;
    std::vector<Vec3> places;
    for (int i = 0; i < count; ++i) {
        const double s = static_cast<double>(i) / (count - 1);
        places.emplace_back(s, 0.1 * std::sin(std::numbers::pi * s), 0.05 * std::sin(2.0 * std::numbers::pi * s));
        if (i > 0) links.push_back({i - 1, i, 0.06, 20.0, 0.02});
    }
    return linked_world(linked_masses(std::vector<double>(count, 0.01), links), places, {0, count - 1}, settings);
}

std::vector<Vec3> string_after(StepSettings settings, double time, int steps) {
    settings.time_step = time / steps;
    settings.measure = StepMeasures::none;
    if (!settings.newton_tolerance) settings.newton_tolerance = 1e-10;
    World world = taut_string(settings);
    for (int n = 0; n < steps; ++n) REQUIRE(step(world).ok());
    return to_points(world.state.cloth.positions, world.scene.model.vertex_count());
}

/// Three masses with random velocities, nothing held, no gravity.
World thrown_masses(Scheme scheme, double time_step) {
    World world =
        make_world(linked_masses({0.2, 0.3, 0.1}, {{0, 1, 1.0, 40.0, 0.1}, {1, 2, 0.7, 60.0, 0.1}, {2, 0, 0.8, 50.0, 0.1}}),
                   {Vec3(0, 0, 0), Vec3(1.1, 0, 0), Vec3(0.5, 0.8, 0.1)},
                   {.time_step = time_step, .scheme = scheme, .newton_tolerance = 1e-12, .gravity = Vec3::Zero()});
    world.state.cloth.velocities.set(0, Vec3(0.5, -1.0, 0.2));
    world.state.cloth.velocities.set(1, Vec3(-0.3, 1.5, 0.4));
    world.state.cloth.velocities.set(2, Vec3(0.1, 0.2, -1.1));
    return world;
}

Vec3 momentum(const World& world) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < world.scene.model.vertex_count(); ++i)
        sum += world.scene.model.mass[i] * world.state.cloth.velocities.at(i);
    return sum;
}

Vec3 angular_momentum(const World& world) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < world.scene.model.vertex_count(); ++i) {
        sum += world.scene.model.mass[i] * world.state.cloth.positions.at(i).cross(world.state.cloth.velocities.at(i));
    }
    return sum;
}

}  // namespace

TEST_CASE("Each scheme has the order of the table, over five halvings", "[law]") {
    constexpr double time = 0.2;
    const std::vector<Vec3> exact = string_after({.scheme = Scheme::rk4}, time, 6400);
    for (const SchemeFacts& facts : scheme_table()) {
        const int first = facts.order == 4 ? 20 : 40;
        double coarser = largest_difference(string_after({.scheme = facts.scheme}, time, first), exact);
        double order = 0.0;
        const int halvings = facts.order == 4 ? 3 : 5;
        for (int halving = 1; halving <= halvings; ++halving) {
            const double finer = largest_difference(string_after({.scheme = facts.scheme}, time, first << halving), exact);
            order = std::log2(coarser / finer);
            CAPTURE(facts.word, halving, coarser, finer);
            CHECK(order == Approx(facts.order).margin(halving < 3 ? 0.4 : 0.12));
            coarser = finer;
        }
        check_law_between("order on a taut string, " + std::string(facts.word), order, facts.order - 0.12, facts.order + 0.12);
    }
}

TEST_CASE("In free fall the error of Euler's schemes is g dt^2 n/2 either way, and all of higher order are exact", "[law]") {
    for (const SchemeFacts& facts : scheme_table()) {
        const TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
        World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices,
                                 {.time_step = 1e-3, .scheme = facts.scheme, .newton_tolerance = 1e-12});
        for (int n = 1; n <= 50; ++n) REQUIRE(step(world).ok());
        const double g = 9.81 * 1e-6, n = 50.0;
        double fall = g * n * n / 2.0;
        if (facts.order == 1) fall += (facts.scheme == Scheme::forward_euler ? -1.0 : 1.0) * g * n / 2.0;
        CAPTURE(facts.word);
        double worst = 0.0;
        for (int i = 0; i < 9; ++i) {
            worst = std::max(worst, (world.state.cloth.positions.at(i) - grid.vertices[i] + Vec3(0, fall, 0)).norm());
            CHECK(world.state.cloth.velocities.at(i).y() == Approx(-9.81e-3 * n).epsilon(1e-9));
        }
        check_law("free fall, " + std::string(facts.word) + ": distance from the exact sum, m", worst, 1e-9);
    }
}

TEST_CASE("Every scheme keeps linear momentum, symplectic Euler and the implicit midpoint angular momentum too", "[law]") {
    for (const SchemeFacts& facts : scheme_table()) {
        World world = thrown_masses(facts.scheme, facts.implicit ? 1e-2 : 1e-3);
        const Vec3 linear = momentum(world), angular = angular_momentum(world);
        for (int n = 0; n < 200; ++n) REQUIRE(step(world).ok());
        CAPTURE(facts.word);
        CHECK((momentum(world) - linear).norm() < 1e-12);
        const double change = (angular_momentum(world) - angular).norm() / angular.norm();
        const bool keeps = facts.scheme == Scheme::symplectic_euler || facts.scheme == Scheme::implicit_midpoint;
        const std::string name = "thrown masses, " + std::string(facts.word) + ": relative change of angular momentum";
        keeps ? check_law(name, change, 1e-10) : report_law(name, figure(change), "none");
    }
}

TEST_CASE("A rotating pair keeps its angular momentum by the implicit midpoint and loses it by backward Euler", "[law]") {
    const auto kept = [](Scheme scheme) {
        World world = make_world(linked_masses({0.2, 0.2}, {{0, 1, 0.8, 400.0, 0.0}}), {Vec3(-0.5, 0, 0), Vec3(0.5, 0, 0)},
                                 {.time_step = 1.0 / 60.0, .scheme = scheme, .newton_tolerance = 1e-12, .gravity = Vec3::Zero()});
        world.state.cloth.velocities.set(0, Vec3(0, 0, -5.0));
        world.state.cloth.velocities.set(1, Vec3(0, 0, 5.0));
        const double start = angular_momentum(world).norm();
        for (int n = 0; n < 120; ++n) REQUIRE(step(world).ok());
        return angular_momentum(world).norm() / start;
    };
    const double midpoint = kept(Scheme::implicit_midpoint), euler = kept(Scheme::backward_euler);
    check_law("spinning pair, implicit midpoint at 1/60 s, 2 s: change of angular momentum", std::abs(midpoint - 1.0), 1e-10);
    check_law_between("spinning pair, backward Euler at 1/60 s, 2 s: angular momentum left", euler, 0.2, 0.7);
}

}  // namespace percale::test::scheme_orders_test
