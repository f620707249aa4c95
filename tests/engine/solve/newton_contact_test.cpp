#include <cmath>
#include <numbers>

#include "engine/solve/newton.h"
#include "tests/support/laws.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::newton_contact_test {
namespace {

constexpr double h = 0.005;  // the sheet's thickness

/// m, of cloth on an incline: 1500 weights would press it through (contact_stiffness.h).
double rest_height(double angle) { return h * (1.0 - std::sqrt(std::cos(angle) / 1500.0)); }

}  // namespace

TEST_CASE("Cloth that fell on a plane rests between three quarters of the thickness and the thickness") {
    for (const double dt : {1.0 / 60.0, 1.0 / 240.0}) {
        SolverScene scene = sheet_on_plane(0.0, 0.3, 0.05, {.time_step = dt});
        run(scene, static_cast<int>(std::round(2.0 / dt)));
        for (int i = 0; i < 16; ++i) {
            CAPTURE(dt, i, scene.state.positions.y[i] / h);
            CHECK(scene.state.positions.y[i] >= 0.75 * h - 1e-5);
            CHECK(scene.state.positions.y[i] < h);
            CHECK(scene.state.velocities.at(i).norm() < 1e-3);
        }
    }
}

TEST_CASE("Cloth thrown at a plane never crosses it") {
    for (const double speed : {1.0, 10.0, 100.0}) {
        SolverScene scene = sheet_on_plane(0.0, 0.3, 0.05);
        for (int i = 0; i < 16; ++i) scene.state.velocities.set(i, Vec3(0.3, -speed, 0.0));
        for (int n = 0; n < 30; ++n) {
            const NewtonReport report = scene.step_implicit();
            REQUIRE(report.end != NewtonEnd::not_finite);
            REQUIRE(report.end != NewtonEnd::blocked);
            for (int i = 0; i < 16; ++i) REQUIRE(scene.state.positions.y[i] > 0.0);
        }
    }
}

TEST_CASE("A plane of up to 100 m/s carries cloth along in undivided steps") {
    for (const double speed : {1.0, 10.0, 100.0}) {
        SolverScene scene = sheet_on_plane(0.0, 0.3, 0.9 * h);
        scene.plan.obstacles_move = true;
        const double way = speed * scene.settings.time_step;
        for (int n = 0; n < 10; ++n) {
            scene.detector->move_obstacle(0, {.translation = Vec3(0, n * way, 0)}, {.translation = Vec3(0, (n + 1) * way, 0)});
            const NewtonReport report = scene.step_implicit();
            CAPTURE(speed, n, report.newton_iterations, report.smallest_fraction);
            REQUIRE((report.end == NewtonEnd::converged || (speed > 10.0 && report.end == NewtonEnd::iterations_used)));
            for (int i = 0; i < 16; ++i) REQUIRE(scene.state.positions.y[i] > (n + 1) * way);
        }
    }
}

TEST_CASE(
    "On an incline flatter than friction's angle cloth gives by less than a twentieth of the thickness and then does not move") {
    const double angle = 20.0 * std::numbers::pi / 180.0;
    for (const double mu : {1.01 * std::tan(angle), 0.6, 1.0}) {
        SolverScene scene = sheet_on_plane(angle, mu, rest_height(angle));
        const std::vector<Vec3> start = scene.state.points;
        run(scene, 120);
        const std::vector<Vec3> held = scene.state.points;
        const Vec3 downhill(std::cos(angle), -std::sin(angle), 0.0);
        run(scene, 600);
        CAPTURE(mu);
        for (std::size_t i = 0; i < held.size(); ++i) CHECK((held[i] - start[i]).dot(downhill) < 0.05 * h);
        CHECK(largest_difference(scene.state.points, held) < 1e-9);
    }
}

TEST_CASE("Friction holds the slope of one half at 0.51 and not at 0.49") {
    for (const double mu : {0.49, 0.51}) {
        SolverScene scene = sheet_on_plane(std::atan(0.5), mu, rest_height(std::atan(0.5)));
        run(scene, 60);
        CAPTURE(mu, mean_velocity(scene).norm());
        CHECK((mean_velocity(scene).norm() < 1e-6) == (mu > 0.5));
    }
}

TEST_CASE("A sheet that falls on a plane flat hardly bounces, less the longer the step") {
    for (const auto& [dt, most] : {std::pair{1.0 / 60.0, 0.08}, {1.0 / 240.0, 0.25}}) {
        SolverScene scene = sheet_on_plane(0.0, 0.3, 0.2, {.time_step = dt});
        double fastest_down = 0.0, fastest_up = 0.0;
        for (int n = 0; n < static_cast<int>(1.0 / dt); ++n) {
            run(scene, 1);
            fastest_down = std::max(fastest_down, -mean_velocity(scene).y());
            fastest_up = std::max(fastest_up, mean_velocity(scene).y());
        }
        CAPTURE(dt, fastest_down, fastest_up);
        CHECK(fastest_down > 1.7);
        CHECK(fastest_up < most * fastest_down);
    }
}

TEST_CASE("On a steeper incline cloth slides with g (sin a - mu cos a)", "[law]") {
    double worst = 0.0;
    const double angle = 20.0 * std::numbers::pi / 180.0;
    for (const double mu : {0.0, 0.1, 0.2, 0.3}) {
        SolverScene scene = sheet_on_plane(angle, mu, rest_height(angle));
        run(scene, 12);
        const Vec3 before = mean_velocity(scene);
        run(scene, 48);
        const Vec3 downhill(std::cos(angle), -std::sin(angle), 0.0);
        const double measured = (mean_velocity(scene) - before).dot(downhill) / 0.8;
        const double expected = 9.81 * (std::sin(angle) - mu * std::cos(angle));
        worst = std::max(worst, std::abs(measured / expected - 1.0));
    }
    check_law("slope of 20 degrees, mu 0 to 0.3: relative error of the acceleration", worst, 0.005);
}

TEST_CASE("The threshold between sticking and sliding is the tangent of the angle", "[law]") {
    const double angle = 20.0 * std::numbers::pi / 180.0;
    double sticks = 1.0, slides = 0.1;
    while (sticks - slides > 2e-4) {
        const double mu = 0.5 * (sticks + slides);
        SolverScene scene = sheet_on_plane(angle, mu, rest_height(angle));
        run(scene, 60);
        (mean_velocity(scene).norm() < 1e-3 ? sticks : slides) = mu;
    }
    check_law("slope of 20 degrees: error of the friction coefficient at which it sticks", std::abs(sticks - std::tan(angle)),
              1e-3);
}

TEST_CASE("Candidates are updated once a solve") {
    SolverScene scene = sheet_on_plane(0.0, 0.3, 0.01);
    run(scene, 5);
    CHECK(static_cast<PlaneDetector&>(*scene.detector).candidate_updates == 5);
}

TEST_CASE("Without gravity a sheet that trembles in the air makes no solve longer for one in contact") {
    const auto iterations = [](bool floating) {
        Simulation simulation({.time_step = 1.0 / 60.0, .gravity = Vec3::Zero()}, std::make_unique<PlaneDetector>());
        simulation.add_obstacle(make_plane(1.0));
        const ClothId thrown =
            simulation.add_cloth(make_grid(0.5, 0.5, 20, 20), sheet_fabric(), {.translation = Vec3(0, 0.02, 0)});
        if (floating) {
            // Its total momentum is 0 but for rounding.
            const ClothId sheet =
                simulation.add_cloth(make_grid(0.5, 0.5, 20, 20), sheet_fabric(), {.translation = Vec3(0, 1, 0)});
            Random random(3);
            std::vector<Vec3> tremble(400);
            for (int i = 0; i < 400; i += 2) tremble[i] = -(tremble[i + 1] = random.point(1e-3));
            simulation.set_velocities(sheet, tremble);
        }
        std::vector<Vec3> velocities(400, Vec3(0.1, -1.0, 0.0));
        for (int i = 0; i < 200; ++i) velocities[i].y() = -0.5;
        simulation.set_velocities(thrown, velocities);
        long sum = 0;
        for (int n = 0; n < 10; ++n) sum += simulation.step().linear_iterations;
        return sum;
    };
    const long alone = iterations(false);
    CAPTURE(alone);
    CHECK(alone > 0);
    CHECK(iterations(true) <= 2 * alone);
}

}  // namespace percale::test::newton_contact_test
