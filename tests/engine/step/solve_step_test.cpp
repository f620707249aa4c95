#include "engine/step/solve_step.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::solve_step_test {
namespace {

World sheet_world(const StepSettings& settings, double height = 0.0) {
    TriangleMesh grid = make_grid(0.5, 0.5, 4, 4);
    for (Vec3& x : grid.vertices) x.y() += height;
    return make_world(cloth_model(grid, sheet_fabric()), grid.vertices, settings);
}

StepReport solve(World& world) {
    StepReport report;
    report.dt = report.smallest_dt = world.scene.settings.time_step;
    plan_step(world);
    if (const StepState* end = solve_step(world.scene, world.state, world.work, report)) world.state = *end;
    finish_motion(world.scene);
    return report;
}

void pin(World& world, int vertex, const Vec3& move) {
    world.scene.script.free[vertex] = 0.0;
    world.scene.script.pin_targets.set(vertex, world.state.cloth.positions.at(vertex) + move);
}

}  // namespace

TEST_CASE("Each scheme has its own path through a step") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4, Scheme::backward_euler}) {
        World world = sheet_world({.time_step = 1e-4, .scheme = scheme});
        const StepReport report = solve(world);
        const double fall = scheme == Scheme::rk4 ? 0.5 : 1.0;
        CHECK(world.state.cloth.positions.y[5] == Approx(-fall * 9.81e-8).epsilon(1e-9));
        CHECK((report.newton_iterations > 0) == (scheme == Scheme::backward_euler));
        CHECK(report.status == StepStatus::ok);
        CHECK(report.smallest_dt == 1e-4);
    }
}

TEST_CASE("A step that does not converge is redone in halves and reports so") {
    World world = sheet_world({.time_step = 1.0 / 60.0, .newton_tolerance = 1e-6, .newton_iterations = 3});
    Random random(5);
    for (int i = 0; i < 16; ++i) world.state.cloth.velocities.set(i, random.point(3.0));
    pin(world, 0, Vec3(0.01, 0, 0));
    const StepReport report = solve(world);
    CAPTURE(report.residual, report.halvings);
    CHECK(report.status == StepStatus::halved);
    CHECK(report.halvings > 0);
    CHECK(report.dropped.not_converged == report.halvings);
    CHECK(report.dropped.total() == report.halvings);
    CHECK(report.smallest_dt < world.scene.settings.time_step);
    CHECK(world.state.cloth.positions.at(0) == world.scene.script.pin_targets.at(0));
    const double parts = world.scene.settings.time_step / report.smallest_dt;
    CHECK(parts == std::round(parts));
}

TEST_CASE("A step of one iteration is linearly implicit and never redone") {
    World world = sheet_world({.newton_iterations = 1});
    Random random(5);
    for (int i = 0; i < 16; ++i) world.state.cloth.velocities.set(i, random.point(3.0));
    const StepReport report = solve(world);
    CHECK(report.status == StepStatus::ok);
    CHECK(report.newton_iterations == 1);
    CHECK(report.halvings == 0);
}

TEST_CASE("The estimated error of a backward Euler step in free fall is its true error, g dt^2 / 2") {
    for (const double dt : {1.0 / 30.0, 1.0 / 120.0}) {
        Simulation simulation({.time_step = dt});
        const ClothId sheet = simulation.add_cloth(make_grid(0.4, 0.4, 5, 5), sheet_fabric());
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        const double off = std::abs(simulation.positions(sheet)[0].y() + 0.5 * 9.81 * dt * dt);
        CHECK(off == Approx(0.5 * 9.81 * dt * dt));
        CHECK(report.time_error == Approx(off));
        CHECK(mentions(report.explanation(), {"estimated error 0.0"}));
    }
    Simulation explicit_one({.time_step = 1e-4, .scheme = Scheme::rk4});
    explicit_one.add_cloth(make_grid(0.4, 0.4, 5, 5), sheet_fabric());
    CHECK(explicit_one.step().time_error == 0.0);
}

TEST_CASE("If halving does not help, the last state is accepted as not converged") {
    World world = sheet_world({.time_step = 1.0 / 60.0, .newton_tolerance = 1e-14, .newton_iterations = 2});
    Random random(5);
    for (int i = 0; i < 16; ++i) world.state.cloth.velocities.set(i, random.point(3.0));
    const StepReport report = solve(world);
    CHECK(report.status == StepStatus::not_converged);
    CHECK(report.smallest_dt == Approx(1.0 / 60.0 / 64.0));
    CHECK(report.residual > 1e-14);
}

TEST_CASE("A pin that is pulled through a plane is blocked and named, with the plane") {
    World world = sheet_world({}, 0.02);
    add_plane(world);
    pin(world, 3, Vec3(0, 0.001, 0));
    pin(world, 9, Vec3(0, -0.03, 0));
    const StepReport report = solve(world);
    CHECK(report.status == StepStatus::pin_blocked);
    CHECK(report.dropped.blocked > 0);
    CHECK(report.blocked_cloth == 0);
    CHECK(report.blocked_vertex == 9);
    CHECK(report.blocked_name == "cloth");
    CHECK(report.blocking_obstacle == 0);
    CHECK(report.blocking_name == "plane");
    CHECK(report.smallest_fraction < 1.0);
}

TEST_CASE("A plane that drives through held cloth is too fast") {
    World world = sheet_world({}, 0.02);
    add_plane(world);
    for (int i = 0; i < 16; ++i) pin(world, i, Vec3::Zero());
    world.scene.script.obstacles[0].end.translation = Vec3(0, 0.05, 0);
    const StepReport report = solve(world);
    CHECK(report.status == StepStatus::obstacle_too_fast);
    CHECK(report.blocking_obstacle == 0);
}

TEST_CASE("A plane that moves under free cloth carries it along") {
    World world = sheet_world({.measure = StepMeasures::all}, 0.02);
    add_plane(world);
    world.scene.script.obstacles[0].end.translation = Vec3(0, 0.05, 0);
    const StepReport report = solve(world);
    CHECK(report.ok());
    for (int i = 0; i < 16; ++i) CHECK(world.state.cloth.positions.y[i] > 0.05);
    CHECK(report.energy.work > 0.0);
}

TEST_CASE("Steps that become shorter do not throw up cloth at rest") {
    const double thickness = sheet_fabric().thickness;
    for (const double shorter : {1.0 / 120.0, 1.0 / 1200.0}) {
        Simulation simulation({}, std::make_unique<PlaneDetector>());
        simulation.add_obstacle(make_plane(1.0));
        const ClothId cloth =
            simulation.add_cloth(make_grid(0.3, 0.3, 5, 5), sheet_fabric(), {.translation = Vec3(0, 1.2 * thickness, 0)});
        for (int n = 0; n < 60; ++n) REQUIRE(simulation.step().ok());
        simulation.set_time_step(shorter);
        double highest = 0.0;
        for (int n = 0; n < static_cast<int>(0.3 / shorter); ++n) {
            REQUIRE(simulation.step().ok());
            for (const Vec3& x : simulation.positions(cloth)) highest = std::max(highest, x.y());
        }
        CAPTURE(shorter, highest / thickness);
        CHECK(highest <= thickness);
    }
}

TEST_CASE("Lifting a whole sheet at constant speed takes the work m g h") {
    World world = sheet_world({.measure = StepMeasures::all});
    const double speed = 0.6, rise = speed / 60.0;
    for (int n = 0; n < 5; ++n) {
        for (int i = 0; i < 16; ++i) pin(world, i, Vec3(0, rise, 0));
        const StepReport report = solve(world);
        const double mass = world.scene.model.cloths[0].mass;
        // Backward Euler pays m v for a change of velocity v, half of which is lost.
        const double expected = mass * 9.81 * rise + (n == 0 ? mass * speed * speed : 0.0);
        CHECK(report.energy.work == Approx(expected).epsilon(1e-9));
    }
}

TEST_CASE("A seam closes while every vertex is pinned") {
    Simulation simulation({.time_step = 0.01});
    const ClothId cloth = simulation.add_cloth(make_grid(0.5, 0.5, 4, 4), sheet_fabric());
    for (int i = 0; i < 16; ++i) simulation.pin(cloth, i);
    const std::vector<std::array<int, 2>> pair = {{0, 3}};
    simulation.add_seam(cloth, cloth, pair, {.over = 0.05, .stiffness = 100.0});
    for (int n = 0; n < 20; ++n) REQUIRE(simulation.step().ok());
    // The seam's spring has no length any more, and is as long as the sheet is wide.
    CHECK(simulation.energy().elastic == Approx(0.5 * 100.0 * 0.25).epsilon(1e-12));
}

}  // namespace percale::test::solve_step_test
