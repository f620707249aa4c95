#pragma once

#include <cmath>
#include <memory>

#include "engine/tolerances.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test {

/// A small sheet `height` above a plane that is tilted by `angle` about z, so that its downhill direction is (cos, -sin, 0).
inline SolverScene sheet_on_plane(double angle, double friction, double height, const StepSettings& settings = {}, int side = 4) {
    const Rotation tilt{std::cos(-0.5 * angle), 0.0, 0.0, std::sin(-0.5 * angle)};
    const Pose pose{.translation = Vec3::Zero(), .rotation = tilt};
    TriangleMesh grid = make_grid(0.2, 0.2, side, side);
    const Vec3 up = transform(pose, Vec3(0, height, 0));
    for (Vec3& x : grid.vertices) x = transform(pose, x) + up;
    SolverScene scene = solver_scene(grid, sheet_fabric(), settings);
    auto detector = std::make_unique<PlaneDetector>();
    std::vector<double> zone = scene.model.thickness;
    const bool projects = settings.contact_response == ContactResponse::projection;
    for (double& thickness : zone) thickness *= projects ? projection_activation_ratio : 1.0;
    detector->set_cloth(scene.model.triangles, zone);
    detector->add_obstacle(make_plane(1.0), pose, friction);
    scene.detector = std::move(detector);
    scene.plan.contacts = true;
    return scene;
}

/// A plane at 0 under the cloth that a world has.
inline void add_plane(World& world) {
    world.scene.detector = std::make_unique<PlaneDetector>();
    world.scene.detector->set_cloth(world.scene.model.triangles, world.scene.model.thickness);
    world.scene.detector->add_obstacle(make_plane(1.0), {}, 0.3);
    world.scene.script.obstacles.push_back({"plane", {}, {}});
}

/// The mean velocity by mass, m/s.
inline Vec3 mean_velocity(const SolverScene& scene) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < scene.model.vertex_count(); ++i) sum += scene.model.mass[i] * scene.state.velocities.at(i);
    return sum / scene.model.cloths[0].mass;
}

/// Makes steps that must converge.
inline void run(SolverScene& scene, int steps) {
    for (int n = 0; n < steps; ++n) {
        const NewtonReport report = scene.step_implicit();
        CAPTURE(n, report.residual, report.newton_iterations);
        REQUIRE(report.end == NewtonEnd::converged);
    }
}

}  // namespace percale::test
