#include "engine/solve/contact_projection.h"

#include <cmath>
#include <numbers>

#include "engine/solve/newton.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test {
namespace {

constexpr double h = 0.005;  // the sheet's thickness

StepSettings projected(double time_step = 1.0 / 60.0) {
    return {.time_step = time_step, .contact_response = ContactResponse::projection};
}

/// A small sheet `height` above a plane that is tilted by `angle` about z, so that its downhill direction is (cos, -sin, 0).
SolverScene sheet_on_plane(double angle, double friction, double height, const StepSettings& settings) {
    const Rotation tilt{std::cos(-0.5 * angle), 0.0, 0.0, std::sin(-0.5 * angle)};
    const Pose pose{.translation = Vec3::Zero(), .rotation = tilt};
    TriangleMesh grid = make_grid(0.2, 0.2, 4, 4);
    const Vec3 up = transform(pose, Vec3(0, height, 0));
    for (Vec3& x : grid.vertices) x = transform(pose, x) + up;
    SolverScene scene = solver_scene(grid, sheet_fabric(), settings);
    auto detector = std::make_unique<PlaneDetector>();
    std::vector<double> zone = scene.model.thickness;
    for (double& thickness : zone) thickness *= projection_zone;
    detector->set_cloth(scene.model.triangles, zone);
    detector->add_obstacle(make_plane(1.0), pose, friction);
    scene.detector = std::move(detector);
    scene.plan.contacts = true;
    return scene;
}

Vec3 mean_velocity(const SolverScene& scene) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < scene.model.vertex_count(); ++i) sum += scene.model.mass[i] * scene.state.velocities.at(i);
    return sum / scene.model.cloths[0].mass;
}

void run(SolverScene& scene, int steps) {
    for (int n = 0; n < steps; ++n) {
        const NewtonReport report = scene.step_implicit();
        CAPTURE(n, report.residual, report.newton_iterations);
        REQUIRE(report.end == NewtonEnd::converged);
    }
}

}  // namespace

TEST_CASE("Projected cloth that fell on a plane rests at the thickness") {
    const auto solver = GENERATE(LinearSolver::automatic, LinearSolver::cg, LinearSolver::direct);
    for (const double dt : {1.0 / 60.0, 1.0 / 240.0}) {
        StepSettings settings = projected(dt);
        settings.linear_solver = solver;
        SolverScene scene = sheet_on_plane(0.0, 0.3, 0.05, settings);
        run(scene, static_cast<int>(std::round(2.0 / dt)));
        for (int i = 0; i < 16; ++i) {
            CAPTURE(dt, i, scene.state.positions.y[i] - h);
            CHECK(scene.state.positions.y[i] == Approx(h).margin(1e-6));
            CHECK(scene.state.velocities.at(i).norm() < 1e-6);
        }
    }
}

double energy(const SolverScene& scene) {
    double sum = elastic_energy(scene.model.springs, scene.state.positions);
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        sum += scene.model.mass[i] * (0.5 * scene.state.velocities.at(i).squaredNorm() + 9.81 * scene.state.positions.y[i]);
    }
    return sum;
}

TEST_CASE("Projected cloth thrown at a plane never crosses it and gains no energy") {
    for (const double speed : {1.0, 10.0, 100.0}) {
        SolverScene scene = sheet_on_plane(0.0, 0.3, 0.05, projected());
        for (int i = 0; i < 16; ++i) scene.state.velocities.set(i, Vec3(0.3, -speed, 0.0));
        const double before = energy(scene);
        for (int n = 0; n < 60; ++n) {
            const NewtonReport report = scene.step_implicit();
            CAPTURE(speed, n, before, energy(scene), report.newton_iterations, report.residual);
            REQUIRE(report.end != NewtonEnd::not_finite);
            REQUIRE(report.end != NewtonEnd::blocked);
            REQUIRE(energy(scene) <= before);
            for (int i = 0; i < 16; ++i) REQUIRE(scene.state.positions.y[i] > 0.0);
        }
    }
}

TEST_CASE("On an incline flatter than friction's angle projected cloth does not move at all") {
    const double angle = 20.0 * std::numbers::pi / 180.0;
    for (const double mu : {1.01 * std::tan(angle), 0.6, 1.0}) {
        SolverScene scene = sheet_on_plane(angle, mu, h, projected());
        const Vec3 before = scene.state.positions.at(5);
        run(scene, 120);
        const Vec3 after = scene.state.positions.at(5);
        run(scene, 60);
        CAPTURE(mu, (after - before).norm(), (scene.state.positions.at(5) - after).norm(), mean_velocity(scene).norm());
        CHECK(mean_velocity(scene).norm() < 1e-9);
        CHECK((scene.state.positions.at(5) - after).norm() < 1e-9);
        CHECK((after - before).norm() < 1e-4);  // until the friction is found
    }
}

TEST_CASE("On a steeper incline projected cloth slides with g (sin a - mu cos a)") {
    const double angle = 20.0 * std::numbers::pi / 180.0;
    for (const double mu : {0.0, 0.1, 0.2, 0.3}) {
        SolverScene scene = sheet_on_plane(angle, mu, h, projected());
        run(scene, 12);
        const Vec3 before = mean_velocity(scene);
        run(scene, 48);
        const Vec3 downhill(std::cos(angle), -std::sin(angle), 0.0);
        const double measured = (mean_velocity(scene) - before).dot(downhill) / 0.8;
        const double expected = 9.81 * (std::sin(angle) - mu * std::cos(angle));
        CAPTURE(mu, measured, expected);
        CHECK(measured == Approx(expected).epsilon(5e-4));
    }
}

TEST_CASE("A plane that moves carries projected cloth along and up") {
    SolverScene scene = sheet_on_plane(0.0, 0.5, h, projected());
    const Vec3 way(0.01, 0.002, 0.0);  // m a step
    const Vec3 start = scene.state.positions.at(5);
    scene.plan.obstacles_move = true;
    for (int n = 0; n < 120; ++n) {
        scene.detector->move_obstacle(0, {.translation = n * way}, {.translation = (n + 1) * way});
        run(scene, 1);
    }
    const Vec3 speed = 60.0 * way;
    CAPTURE(mean_velocity(scene).transpose());
    CHECK((mean_velocity(scene) - speed).norm() < 1e-6);
    CHECK(scene.state.positions.at(5).y() == Approx(start.y() + 120 * way.y()).margin(1e-6));
}

TEST_CASE("The threshold between sticking and sliding of projected cloth is the tangent of the angle") {
    const double angle = std::atan(0.5);
    double sticks = 1.0, slides = 0.1;
    while (sticks - slides > 2e-4) {
        const double mu = 0.5 * (sticks + slides);
        SolverScene scene = sheet_on_plane(angle, mu, h, projected());
        run(scene, 120);
        (mean_velocity(scene).norm() < 1e-6 ? sticks : slides) = mu;
    }
    CAPTURE(sticks);
    CHECK(std::abs(sticks - 0.5) < 1e-3);
}

}  // namespace percale::test
