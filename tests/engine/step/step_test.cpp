#include "engine/step/step.h"

#include <limits>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::step_test {
namespace {

World sheet_world(const StepSettings& settings) {
    TriangleMesh grid = make_grid(0.5, 0.5, 4, 4);
    for (Vec3& x : grid.vertices) x.y() += 0.02;
    return make_world(cloth_model(grid, sheet_fabric()), grid.vertices, settings);
}

}  // namespace

TEST_CASE("A good step advances time and reports the length of the step") {
    World world = sheet_world({.time_step = 0.01});
    for (int n = 1; n <= 3; ++n) {
        const StepReport report = step(world);
        CHECK(report.status == StepStatus::ok);
        CHECK(report.time == Approx(0.01 * n).epsilon(1e-14));
        CHECK(report.dt == 0.01);
        CHECK(world.state.time == report.time);
    }
}

TEST_CASE("A step that would become infinite is not accepted") {
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4, Scheme::backward_euler}) {
        World world = sheet_world({.time_step = 0.01, .scheme = scheme});
        world.state.cloth.positions.set(3, Vec3(1e200, 0, 0));
        world.state.cloth.velocities.set(3, Vec3(1e308, 1e308, 0));
        update_points(world.state.cloth);
        const ClothState before = world.state.cloth;
        const StepReport report = step(world);
        CHECK(report.status == StepStatus::not_finite);
        CHECK_FALSE(report.ok());
        CHECK(report.time == 0.0);
        CHECK(same_bits(world.state.cloth.positions, before.positions));
        CHECK(same_bits(world.state.cloth.velocities, before.velocities));
        CHECK(world.state.cloth.points == before.points);
    }
}

TEST_CASE("An explicit scheme that diverges ends in a status, and the last finite state is kept") {
    World world = sheet_world({.time_step = 1.0 / 60.0, .scheme = Scheme::symplectic_euler});
    world.scene.script.free[0] = 0.0;
    StepReport report;
    for (int n = 0; n < 10000 && report.ok(); ++n) report = step(world);
    CHECK(report.status == StepStatus::not_finite);
    for (const Vec3& x : world.state.cloth.points) CHECK(x.allFinite());
}

TEST_CASE("A failed step leaves state, time and obstacles untouched and the next step may succeed") {
    World world = sheet_world({});
    world.scene.detector = std::make_unique<PlaneDetector>();
    world.scene.detector->set_cloth(world.scene.model.triangles, world.scene.model.thickness);
    world.scene.detector->add_obstacle(make_plane(1.0), {}, 0.3);
    world.scene.script.obstacles.push_back({"plane", {}, {}});
    world.scene.script.free[5] = 0.0;
    step(world);
    const ClothState before = world.state.cloth;
    const double time = world.state.time;
    world.scene.script.pin_targets.set(5, world.state.cloth.positions.at(5) - Vec3(0, 0.5, 0));
    const StepReport report = step(world);
    CHECK(report.status == StepStatus::pin_blocked);
    CHECK(world.state.time == time);
    CHECK(same_bits(world.state.cloth.positions, before.positions));
    CHECK(same_bits(world.state.cloth.velocities, before.velocities));
    CHECK(world.state.cloth.points == before.points);
    world.scene.script.pin_targets.set(5, world.state.cloth.positions.at(5));
    CHECK(step(world).ok());
}

}  // namespace percale::test::step_test
