#include "engine/solve/direction.h"

#include <cmath>
#include <memory>
#include <utility>

#include "tests/support/catch.h"
#include "tests/support/one_stage.h"

namespace percale::test::direction_test {
namespace {

/// A crumpled sheet at the first point of a stage.
struct FirstPoint {
    SolverScene scene = solver_scene(make_grid(1.0, 1.0, 5, 5), sheet_fabric(), {.linear_solver = LinearSolver::direct});
    ContactWarmStart warm_start;
    std::unique_ptr<ImplicitStage> stage;
    std::unique_ptr<StageSearch> search;
    Direction found;

    explicit FirstPoint(NewtonOptions options = {}, int pinned = -1) {
        Random random(8);
        for (int i = 0; i < 25; ++i) scene.state.positions.add(i, random.point(0.03));
        for (int i = 0; i < 25; ++i) scene.state.velocities.set(i, random.point(1.0));
        if (pinned >= 0) scene.pin(pinned);
        scene.before = scene.state;
        scene.targets = scene.state.positions;
        set_euler_base(scene.before, scene.settings.time_step, scene.base);
        stage = std::make_unique<ImplicitStage>(ImplicitStage{
            .scene = scene, .base = scene.base, .start = scene.before, .targets = scene.targets, .options = options});
        search = std::make_unique<StageSearch>(*stage, warm_start, scene);
        search->evaluate();
    }
    void solve(const SolveTarget& target) {
        search->space.system.find_direction(search->equations, search->space.current, {search->space.bodies, target}, found);
    }
    const Vec3Arrays& residual() const { return scene.newton.current.residual; }
    const Vec3Arrays& direction() const { return found.velocity; }
};

}  // namespace

TEST_CASE("The Newton direction solves A dv = -r on free vertices and leaves prescribed ones") {
    FirstPoint point({}, 12);
    point.solve({.relative_residual = 1e-12});
    CHECK(point.found.exact);
    CHECK(point.direction().at(12) == Vec3::Zero());
    Vec3Arrays product;
    product.resize(25);
    AlignedVector<double> points;
    multiply(point.scene.newton.system.solver.matrix, point.direction(), points, product);
    double largest = 0.0;
    for (int i = 0; i < 25; ++i) largest = std::max(largest, point.residual().at(i).norm());
    for (int i = 0; i < 25; ++i) CHECK((product.at(i) + point.residual().at(i)).norm() < 1e-7 * largest);
}

TEST_CASE("Along the Newton direction the objective falls") {
    FirstPoint point;
    point.solve({.relative_residual = 1e-8});
    CHECK(dot(compute, point.residual(), point.direction()) < 0.0);
    std::swap(point.scene.newton.direction, point.found);
    point.search->go(0.1);
    CHECK(point.scene.newton.trial.objective < point.scene.newton.current.objective);
}

TEST_CASE("Without Jacobians the direction is the residual over the mass") {
    FirstPoint point({.jacobians = false});
    point.solve({});
    for (int i = 0; i < 25; ++i) CHECK(point.direction().at(i) == -point.residual().at(i) / point.scene.model.mass[i]);
}

TEST_CASE("A cloth that nothing holds receives its whole momentum, however loosely the system is solved") {
    FirstPoint point;
    point.solve({.relative_residual = 0.3, .max_iterations = 2});
    Vec3 left = Vec3::Zero(), all = Vec3::Zero();
    for (int i = 0; i < 25; ++i) {
        left += point.scene.model.mass[i] * point.direction().at(i) + point.residual().at(i);
        all += point.residual().at(i);
    }
    CHECK(left.norm() < 1e-12 * all.norm());
}

TEST_CASE("A prescribed vertex on its way moves to its target") {
    FirstPoint point({}, 4);
    point.scene.plan.pins_move = true;
    point.scene.newton.current.fraction = 0.5;
    point.scene.targets.set(4, point.scene.before.positions.at(4) + Vec3(0.02, 0.0, 0.0));
    point.solve({.relative_residual = 1e-8});
    CHECK((point.direction().at(4) - Vec3(0.02 * 60.0, 0.0, 0.0)).norm() < 1e-9);
}

TEST_CASE("Block Jacobi gives no estimate of the next change") {
    FirstPoint point;
    CHECK_FALSE(point.scene.newton.system.estimate_direction(point.search->equations, point.scene.newton.current, point.found));
}

}  // namespace percale::test::direction_test
