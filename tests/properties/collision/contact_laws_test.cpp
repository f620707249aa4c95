#include <cmath>
#include <numbers>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/contact_laws.h"
#include "tests/support/laws.h"

namespace percale::test::contact_laws_test {
namespace {

constexpr double h = 0.005, g = 9.81;

Fabric fabric(double spring_damping = 0.1) {
    return {.area_density = 0.2,
            .thickness = h,
            .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0},
            .spring_damping = spring_damping};
}

Rotation about_y(double angle) { return {std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0}; }

/// A strip without weight over a cylinder about y, pinned at one end and pulled at the other. It runs straight, round `angle`,
/// and straight again.
struct Strip {
    static constexpr int columns = 65;
    static constexpr double radius = 0.1, straight = 0.1, width = 0.04, angle = std::numbers::pi, prestretch = 1.01;
    Simulation simulation;
    ClothId cloth;

    Strip(double friction, ContactResponse response, int facets = 256)
        : simulation(simulation_on_meshes({.time_step = 1.0 / 60.0, .contact_response = response, .gravity = Vec3::Zero()})) {
        const double round = radius + 0.95 * h, length = (2.0 * straight + angle * round) / prestretch;
        Fabric band = fabric();
        band.springs = {.structural = 1000.0, .shear = 0.0, .bend = 0.0};
        cloth = simulation.add_cloth(make_grid(length, width, columns, 2), band);
        simulation.add_obstacle(make_cylinder(radius, 0.2, facets), {}, {.friction = friction, .name = "cylinder"});
        std::vector<Vec3> places;
        for (int row = 0; row < 2; ++row) {
            for (int column = 0; column < columns; ++column) {
                places.push_back(place(round, column * length * prestretch / (columns - 1), (row - 0.5) * width));
            }
        }
        simulation.set_positions(cloth, places);
        for (const int vertex : {0, columns - 1, columns, 2 * columns - 1}) simulation.pin(cloth, vertex);
    }

    static Vec3 place(double round, double s, double y) {
        const double way = s - straight, turn = std::clamp(way / round, 0.0, angle);
        const Vec3 tangent(-std::sin(turn), 0.0, std::cos(turn));
        return Vec3(round * std::cos(turn), y, round * std::sin(turn)) + (way - turn * round) * tangent;
    }

    StepReport pull(double way) {
        for (const int vertex : {columns - 1, 2 * columns - 1}) {
            simulation.move_pin(cloth, vertex, simulation.positions(cloth)[vertex] - Vec3(0.0, 0.0, way));
        }
        return step_well(simulation);
    }

    /// Length of a segment of the first row beyond its rest length, m.
    double stretch(int segment) const {
        const auto x = simulation.positions(cloth);
        const double rest = (2.0 * straight + angle * (radius + 0.95 * h)) / prestretch / (columns - 1);
        return (x[segment + 1] - x[segment]).norm() - rest;
    }

    /// Ratio of the tensions at the ends if every vertex slides.
    double sliding_ratio(double friction) const {
        const auto x = simulation.positions(cloth);
        double ratio = 1.0;
        for (int i = 1; i + 1 < columns; ++i) {
            const Vec3 before = (x[i] - x[i - 1]).normalized(), after = (x[i + 1] - x[i]).normalized();
            const double half = friction * std::tan(0.5 * std::atan2(before.cross(after).norm(), before.dot(after)));
            ratio *= (1.0 + half) / (1.0 - half);
        }
        return ratio;
    }
};

}  // namespace

TEST_CASE("A strip pulled over a cylinder has the tensions of the capstan", "[law]") {
    const ContactResponse response = GENERATE(ContactResponse::penalty, ContactResponse::projection);
    const bool penalty = response == ContactResponse::penalty;
    for (const double friction : {0.1, 0.5}) {
        Strip strip(friction, response);
        for (int i = 0; i < 30; ++i) strip.pull(0.0005);
        // Facets pass under the vertices: the ratio oscillates about its mean.
        double error = 0.0;
        for (int i = 0; i < 30; ++i) {
            strip.pull(0.0005);
            const double now = strip.stretch(Strip::columns - 2) / strip.stretch(0);
            CAPTURE(penalty, friction, i, now, strip.sliding_ratio(friction), std::exp(friction * Strip::angle));
            CHECK(now == Approx(std::exp(friction * Strip::angle)).epsilon(0.03));
            error += (now / strip.sliding_ratio(friction) - 1.0) / 30.0;
        }
        check_law("capstan over half a turn, mu " + figure(friction) + (penalty ? "" : ", projection") +
                      ": relative error of the mean ratio of tensions",
                  std::abs(error), 0.01);
    }
}

TEST_CASE("Cloth that slides tightly round a coarse cylinder takes few iterations", "[law]") {
    // Its cross threads are parallel to the edges that they slide over.
    Strip strip(0.5, ContactResponse::penalty, 64);
    int iterations = 0, cut = 0;
    for (int i = 0; i < 60; ++i) {
        const StepReport report = strip.pull(0.0005);
        iterations += report.newton_iterations;
        cut += report.halvings;
    }
    CHECK(cut == 0);
    check_law("strip pulled round a cylinder of 64 facets, mu 0.5: mean Newton iterations", iterations / 60.0, 15.0);
}

TEST_CASE("A sheet slides down a slope as one piece, over the edge between its two triangles", "[law]") {
    constexpr double angle = 25.0 * std::numbers::pi / 180.0, mu = 0.3;
    const double exact = g * (std::sin(angle) - mu * std::cos(angle));
    const Rotation tilt{std::cos(-0.5 * angle), 0.0, 0.0, std::sin(-0.5 * angle)};
    for (const int n : {17, 33}) {
        for (const double dt : {1.0 / 30.0, 1.0 / 60.0, 1.0 / 120.0}) {
            Simulation simulation = simulation_on_meshes({.time_step = dt, .measure = StepMeasures::all});
            TriangleMesh sheet = make_grid(0.5, 0.5, n, n);
            for (Vec3& x : sheet.vertices) x.y() += 1.04 * h;
            const ClothId cloth = simulation.add_cloth(sheet, fabric(), {.translation = Vec3::Zero(), .rotation = tilt});
            simulation.add_obstacle(make_plane(5.0), {.translation = Vec3::Zero(), .rotation = tilt}, {.friction = mu});
            const int steps = static_cast<int>(std::lround(1.0 / dt));
            long iterations = 0;
            double strain = 0.0;
            for (int i = 0; i < steps; ++i) {
                const StepReport report = step_well(simulation);
                iterations += report.newton_iterations;
                strain = std::max(strain, report.largest_strain);
            }
            const Vec3 downhill(std::cos(angle), -std::sin(angle), 0.0);
            CAPTURE(n, dt, exact);
            CHECK(mean(simulation.velocities(cloth)).dot(downhill) == Approx(exact).epsilon(2e-3));
            CHECK(strain < 1e-3);
            CHECK(static_cast<double>(iterations) / steps < 3.0);
        }
    }
}

TEST_CASE("A conveyor carries cloth along once friction has sped it up", "[law]") {
    const double mu = 0.3, speed = 0.5, dt = 1.0 / 60.0;
    Simulation simulation = simulation_on_meshes({.time_step = dt});
    const ClothId cloth =
        simulation.add_cloth(make_grid(0.2, 0.2, 5, 5), fabric(), {.translation = Vec3(-0.5, 0.05 + 0.8 * h, 0.0)});
    const ObstacleId belt = simulation.add_obstacle(make_box(Vec3(3.0, 0.1, 1.0)), {}, {.friction = mu, .name = "belt"});
    for (int i = 0; i < 60; ++i) step_well(simulation);
    const Vec3 start = mean(simulation.positions(cloth));
    for (int i = 1; i <= 60; ++i) {
        simulation.move_obstacle(belt, {.translation = Vec3(i * speed * dt, 0.0, 0.0)});
        step_well(simulation);
        const double expected = std::min(mu * g * i * dt, speed);
        CAPTURE(i);
        CHECK(mean(simulation.velocities(cloth)).x() == Approx(expected).epsilon(0.02).margin(0.01));
    }
    for (const Vec3& v : simulation.velocities(cloth)) CHECK((v - Vec3(speed, 0, 0)).norm() < 1e-3);
    // It lags behind by v^2/(2 mu g), and by a step's rounding of the time.
    const double lag = speed - (mean(simulation.positions(cloth)) - start).x();
    check_law("conveyor: error of how far cloth lags behind, m", std::abs(lag - speed * speed / (2.0 * mu * g)),
              0.5 * speed * dt + 1e-3);
}

TEST_CASE("A turning ball carries the cloth on it along, through steps of any length", "[law]") {
    const double spin = 2.0;
    for (const double dt : {1.0 / 60.0, 1.0 / 240.0}) {
        Simulation simulation = simulation_on_meshes({.time_step = dt});
        const ClothId cloth =
            simulation.add_cloth(make_grid(0.3, 0.3, 9, 9), fabric(), {.translation = Vec3(0.0, 0.25 + h, 0.0)});
        const ObstacleId ball = simulation.add_obstacle(make_sphere(0.25, 3), {}, {.friction = 0.8, .name = "ball"});
        const int steps = static_cast<int>(std::lround(1.0 / dt));
        for (int i = 0; i < steps; ++i) step_well(simulation);
        for (int i = 1; i <= 2 * steps; ++i) {
            simulation.move_obstacle(ball, {.rotation = about_y(spin * i * dt)});
            step_well(simulation);
        }
        double momentum = 0.0, inertia = 0.0;
        const auto x = simulation.positions(cloth), v = simulation.velocities(cloth);
        for (std::size_t i = 0; i < x.size(); ++i) {
            momentum += x[i].z() * v[i].x() - x[i].x() * v[i].z();
            inertia += x[i].z() * x[i].z() + x[i].x() * x[i].x();
        }
        check_law("sheet on a turning ball at " + figure(1.0 / dt, 3) + " steps a second: relative error of its turning",
                  std::abs(momentum / inertia / spin - 1.0), 0.01);
    }
}

TEST_CASE("A sheet on a ball comes to rest and falls asleep, at half the thickness or more") {
    Simulation simulation = simulation_on_meshes({.time_step = 1.0 / 60.0});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 17, 17), fabric(1.0), {.translation = Vec3(0.01, 0.3, 0.02)});
    simulation.add_obstacle(make_sphere(0.25, 3), {}, {.friction = 0.4, .name = "ball"});
    StepReport report;
    for (int i = 0; i < 900 && !report.slept; ++i) {
        report = simulation.step();
        REQUIRE(report.ok());
    }
    CHECK(report.slept);
    CHECK(report.smallest_distance > 0.25 * h);
    CHECK(mean(simulation.positions(cloth)).y() > 0.1);
}

TEST_CASE("Projected cloth that falls on a ball takes few iterations while it hits and folds", "[law]") {
    Simulation simulation = simulation_on_meshes({.time_step = 1.0 / 60.0, .contact_response = ContactResponse::projection});
    simulation.add_cloth(make_grid(1.0, 1.0, 33, 33), fabric(1.0), {.translation = Vec3(0.0, 0.3, 0.0)});
    simulation.add_obstacle(make_sphere(0.25, 4), {}, {.friction = 0.3, .name = "ball"});
    int iterations = 0;
    constexpr int steps = 60;
    for (int i = 0; i < steps; ++i) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        iterations += report.newton_iterations;
    }
    check_law("projected sheet on a ball: mean Newton iterations of its first second", static_cast<double>(iterations) / steps,
              10.0);
}

TEST_CASE("Cloth stretched over the edges of a box and its corners keeps a quarter of the thickness") {
    constexpr int n = 11, steps = 120;
    Simulation simulation = simulation_on_meshes({.time_step = 1.0 / 60.0, .measure = StepMeasures::all});
    const ClothId cloth =
        simulation.add_cloth(make_grid(0.6, 0.6, n, n), fabric(1.0), {.translation = Vec3(0.013, 0.207, 0.011)});
    simulation.add_obstacle(make_box(Vec3(0.2, 0.4, 0.2)), {}, {.friction = 0.3, .name = "box"});
    const std::vector<Vec3> start(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
    const auto at_border = [](int i) { return i % n == 0 || i % n == n - 1 || i / n == 0 || i / n == n - 1; };
    for (int i = 0; i < n * n; ++i) {
        if (at_border(i)) simulation.pin(cloth, i);
    }
    StepReport report;
    for (int s = 1; s <= 2 * steps; ++s) {
        const double way = std::min(1.0, static_cast<double>(s) / steps);
        for (int i = 0; i < n * n; ++i) {
            if (at_border(i)) simulation.move_pin(cloth, i, start[i] + way * Vec3(0.1 * start[i].x(), -0.15, 0.1 * start[i].z()));
        }
        report = simulation.step();
        REQUIRE(report.ok());
    }
    CHECK(report.largest_strain > 0.2);
    CHECK(report.smallest_distance > 0.25 * h);
}

TEST_CASE("A light sheet that falls on a ball never gains energy") {
    Fabric light = fabric();
    light.area_density = 0.02;
    Simulation simulation = simulation_on_meshes({.time_step = 1.0 / 60.0, .measure = StepMeasures::all});
    simulation.add_cloth(make_grid(0.6, 0.6, 17, 17), light, {.translation = Vec3(0.03, 0.5, 0.01)});
    simulation.add_obstacle(make_sphere(0.25, 3), {}, {.friction = 0.3, .name = "ball"});
    double before = simulation.energy().total();
    const double start = before;
    for (int i = 0; i < 90; ++i) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        CAPTURE(i, report.contacts);
        CHECK(report.energy.total() <= before + 1e-5 * start);
        before = report.energy.total();
    }
}

TEST_CASE("Stick anchors of vertices are part of the state") {
    const auto make = [] {
        Simulation simulation = simulation_on_meshes({.time_step = 1.0 / 60.0, .gravity = Vec3(0.0, -g, 0.0)});
        simulation.add_cloth(make_grid(0.2, 0.2, 4, 4), fabric(), {.translation = Vec3(0.0, 0.05 + 0.8 * h, 0.0)});
        simulation.add_obstacle(make_box(Vec3(1.0, 0.1, 1.0)), {}, {.friction = 0.8, .name = "table"});
        for (int i = 0; i < 30; ++i) step_well(simulation);
        simulation.set_gravity(Vec3(0.3 * g, -g, 0.0));
        for (int i = 0; i < 30; ++i) step_well(simulation);
        return simulation;
    };
    Simulation a = make(), b = make();
    REQUIRE(a.state_hash() == b.state_hash());
    const ClothId cloth{0};
    const std::vector<Vec3> x(b.positions(cloth).begin(), b.positions(cloth).end());
    b.set_positions(cloth, x);
    CHECK(a.state_hash() != b.state_hash());
    // With its stick anchors it stays; reset cloth slips until it sticks again.
    step_well(a);
    step_well(b);
    CHECK((mean(a.positions(cloth)) - mean(x)).norm() < 1e-3 * h);
    CHECK((mean(b.positions(cloth)) - mean(x)).norm() > 1e-3 * h);
}

}  // namespace percale::test::contact_laws_test
