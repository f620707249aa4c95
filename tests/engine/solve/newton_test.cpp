#include "engine/solve/newton.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/dense_backward_euler.h"
#include "tests/support/dense_system.h"

namespace percale::test::newton_test {
namespace {

/// A sheet that starts crumpled and moving, hung from two corners.
SolverScene crumpled_sheet(const StepSettings& settings, int size = 5) {
    SolverScene scene = solver_scene(make_grid(1.0, 1.0, size, size), sheet_fabric(), settings);
    Random random(17);
    for (int i = 0; i < size * size; ++i) {
        scene.state.positions.add(i, random.point(0.2 / size));
        scene.state.velocities.set(i, random.point(1.0));
    }
    for (const int corner : {0, size - 1}) {
        scene.pin(corner);
        scene.state.velocities.set(corner, Vec3::Zero());
    }
    update_points(scene.state);
    scene.targets = scene.state.positions;
    return scene;
}

SolverScene scene_without_jacobians(int iterations) {
    SolverScene scene =
        crumpled_sheet({.time_step = 1e-4, .newton_iterations = iterations, .damping_form = DampingForm::velocity});
    scene.options = {.jacobians = false, .line_search = false, .predict = false};
    return scene;
}

}  // namespace

TEST_CASE("With Jacobians of zero and one iteration backward Euler is symplectic Euler, bit for bit", "[law]") {
    SolverScene implicit = scene_without_jacobians(1), explicit_one = scene_without_jacobians(1);
    for (int n = 0; n < 200; ++n) {
        implicit.step_implicit();
        explicit_one.step_explicit();
        REQUIRE(same_bits(implicit.state.positions, explicit_one.state.positions));
        REQUIRE(same_bits(implicit.state.velocities, explicit_one.state.velocities));
    }
    CHECK(implicit.state.points == explicit_one.state.points);
}

TEST_CASE("With Jacobians of zero and more iterations backward Euler is a fixed-point iteration") {
    SolverScene twice = scene_without_jacobians(2), once = scene_without_jacobians(1);
    const Vec3Arrays start = once.state.velocities;
    once.step_implicit();
    // The second iteration: forces at the end of the first, applied to the start velocities.
    ExplicitSpace space;
    SpringTerms terms;
    StepSprings springs;
    set_step_springs(compute, {once.model.adjacency, once.state.positions, DampingForm::velocity, 1e-4}, springs);
    Vec3Arrays forces;
    forces.resize(25);
    evaluate_springs(compute, springs, {once.state.positions, once.state.velocities, 1e-4}, false, forces, terms);
    twice.step_implicit();
    for (int i = 0; i < 25; ++i) {
        const Vec3 gained = once.script.free[i] * 1e-4 * (forces.at(i) / once.model.mass[i] + once.settings.gravity);
        CHECK((twice.state.velocities.at(i) - start.at(i) - gained).norm() <= 1e-12);
    }
}

TEST_CASE("Free fall of backward Euler is y0 - g dt^2 n(n+1)/2, whatever the stopping rule") {
    for (const std::optional<double>& tolerance : {std::optional<double>(), std::optional<double>(1e-10)}) {
        const TriangleMesh grid = make_grid(1.0, 1.0, 5, 5);
        SolverScene scene = solver_scene(grid, sheet_fabric(), {.newton_tolerance = tolerance});
        for (int n = 1; n <= 60; ++n) {
            const NewtonReport report = scene.step_implicit();
            REQUIRE(report.end == NewtonEnd::converged);
            const double fall = 9.81 / 3600.0 * n * (n + 1) / 2.0;
            for (int i = 0; i < 25; ++i) {
                REQUIRE((scene.state.positions.at(i) - grid.vertices[i] + Vec3(0.0, fall, 0.0)).norm() < 1e-9);
            }
        }
    }
}

TEST_CASE("The converged step is the minimum that a dense solver finds") {
    for (const double dt : {1.0 / 240.0, 1.0 / 60.0}) {
        SolverScene scene = crumpled_sheet({.time_step = dt, .newton_tolerance = 1e-10});
        const DenseBackwardEuler dense(scene);
        const Eigen::VectorXd expected = dense.solve();
        const NewtonReport report = scene.step_implicit();
        CAPTURE(dt, report.newton_iterations, report.residual);
        CHECK(report.end == NewtonEnd::converged);
        CHECK(report.residual <= 1e-10);
        const Eigen::VectorXd v = to_dense(scene.state.velocities, 25);
        CHECK(dense.gradient(expected).norm() <= 1e-9 * dense.gradient(dense.start()).norm());
        CHECK((v - expected).norm() <= 1e-7 * expected.norm());
        for (int i = 0; i < 25; ++i) {
            CHECK(scene.state.positions.at(i) == scene.before.positions.at(i) + dt * scene.state.velocities.at(i));
        }
    }
}

TEST_CASE("A step so long that it has several minima ends in one of them") {
    SolverScene scene = crumpled_sheet({.time_step = 0.1, .newton_tolerance = 1e-10});
    const DenseBackwardEuler dense(scene);
    CHECK(scene.step_implicit().end == NewtonEnd::converged);
    const Eigen::VectorXd v = to_dense(scene.state.velocities, 25);
    CHECK(dense.gradient(v).norm() <= 1e-9 * dense.gradient(dense.start()).norm());
    CHECK(dense.objective(v) < dense.objective(dense.start()));
    Random random(3);
    for (int trial = 0; trial < 100; ++trial) {
        Eigen::VectorXd beside = v;
        for (int i = 0; i < v.size(); ++i) beside[i] += scene.script.free[i / 3] * random.number(-0.01, 0.01);
        CHECK(dense.objective(beside) > dense.objective(v));
    }
}

TEST_CASE("The residual is the gradient of the incremental potential") {
    SolverScene scene = crumpled_sheet({.newton_iterations = 1}), further = crumpled_sheet({.newton_iterations = 2});
    const DenseBackwardEuler dense(scene);
    scene.step_implicit();  // one iteration, so that there is a residual left
    further.step_implicit();
    const Eigen::VectorXd v = to_dense(scene.state.velocities, 25), residual = to_dense(scene.newton.current.residual, 25);
    CHECK(residual.norm() > 1e-6);
    for (int i = 0; i < v.size(); ++i) {
        if (scene.script.free[i / 3] == 0.0) {
            CHECK(residual[i] == 0.0);
            continue;
        }
        Eigen::VectorXd ahead = v, behind = v;
        ahead[i] += 1e-4;
        behind[i] -= 1e-4;
        const double slope = (dense.objective(ahead) - dense.objective(behind)) / 2e-4;
        CHECK(slope == Approx(residual[i]).epsilon(1e-5).margin(1e-6 * residual.norm()));
    }
    // The engine's objective leaves out terms that are the same for all v.
    const Eigen::VectorXd next = to_dense(further.state.velocities, 25);
    const double change = further.newton.current.objective - scene.newton.current.objective;
    CHECK(change == Approx(dense.objective(next) - dense.objective(v)).epsilon(1e-9));
    CHECK(change < 0.0);
}

TEST_CASE("The incremental potential falls with every iteration") {
    double before = std::numeric_limits<double>::infinity();
    for (int iterations = 1; iterations <= 12; ++iterations) {
        SolverScene scene = crumpled_sheet({.time_step = 0.05, .newton_tolerance = 1e-12, .newton_iterations = iterations}, 9);
        const DenseBackwardEuler dense(scene);
        scene.step_implicit();
        const double now = dense.objective(to_dense(scene.state.velocities, 81));
        CAPTURE(iterations);
        CHECK(now < before + 1e-12);
        before = now;
    }
}

TEST_CASE("Running out of iterations is reported and the state is the best one found") {
    SolverScene scene = crumpled_sheet({.time_step = 0.05, .newton_tolerance = 1e-12, .newton_iterations = 2});
    const Vec3Arrays start = scene.state.positions;
    const NewtonReport report = scene.step_implicit();
    CHECK(report.end == NewtonEnd::iterations_used);
    CHECK(report.newton_iterations == 2);
    CHECK(report.residual > 1e-12);
    CHECK_FALSE(same_bits(scene.state.positions, start));
}

TEST_CASE("The automatic rule stops well within the error of the step, sooner than a tight residual") {
    SolverScene scene = crumpled_sheet({.time_step = 1.0 / 60.0}, 9), tight = crumpled_sheet({.newton_tolerance = 1e-10}, 9);
    const std::vector<Vec3> start = scene.state.points;
    for (int n = 0; n < 10; ++n) {
        // Both from the same state, so that one step's solver error is compared with that step's time error.
        tight.state = scene.state;
        const Vec3Arrays velocities = scene.state.velocities;
        const NewtonReport automatic = scene.step_implicit(), exact = tight.step_implicit();
        REQUIRE(automatic.end == NewtonEnd::converged);
        CHECK(automatic.newton_iterations <= exact.newton_iterations);
        double error = 0.0, time_error = 0.0;
        for (int i = 0; i < 81; ++i) {
            error += scene.model.mass[i] * (scene.state.positions.at(i) - tight.state.positions.at(i)).squaredNorm();
            time_error += scene.model.mass[i] * (tight.state.velocities.at(i) - velocities.at(i)).squaredNorm() / 120.0 / 120.0;
        }
        CAPTURE(n, std::sqrt(error), std::sqrt(time_error));
        CHECK(std::sqrt(error) <= 0.5 * std::sqrt(time_error) + 1e-6);
    }
}

TEST_CASE("A state that is not finite is reported and left as it was") {
    SolverScene scene = crumpled_sheet({});
    scene.state.velocities.set(7, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
    const Vec3Arrays positions = scene.state.positions;
    CHECK(scene.step_implicit().end == NewtonEnd::not_finite);
    CHECK(same_bits(scene.state.positions, positions));
}

TEST_CASE("Prescribed vertices arrive exactly and pull the rest along") {
    SolverScene scene = crumpled_sheet({.newton_tolerance = 1e-8});
    scene.plan.pins_move = true;
    const Vec3 target = scene.targets.at(0) + Vec3(0.01, 0.02, -0.01);
    scene.targets.set(0, target);
    const NewtonReport report = scene.step_implicit();
    CHECK(report.end == NewtonEnd::converged);
    CHECK(scene.state.positions.at(0) == target);
    CHECK(scene.state.positions.at(4) == scene.targets.at(4));
    CHECK((scene.state.velocities.at(0) - 60.0 * Vec3(0.01, 0.02, -0.01)).norm() < 1e-12);
}

}  // namespace percale::test::newton_test
