#pragma once

#include <limits>
#include <vector>

#include "tests/support/collision/backends.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/steps.h"

// A sheet and obstacles for tests of detectors.
namespace percale::test {

inline constexpr double sheet_thickness = 0.03;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

enum class Scene { ball, box, spiky, two, single_triangle, plane };

inline std::vector<TriangleMesh> meshes(Scene scene) {
    switch (scene) {
        case Scene::ball:
            return {make_sphere(0.25, 2)};
        case Scene::box:
            return {make_box({0.4, 0.3, 0.35})};
        case Scene::spiky:
            return {spiky_ball(0.25, 1, 0.5, 17)};
        case Scene::two:
            return {make_box({0.2, 0.4, 0.2}), moved(make_sphere(0.15, 1), {0.4, 0, 0})};
        case Scene::single_triangle:
            return {{.vertices = {{-0.3, 0, -0.2}, {0.3, 0, -0.2}, {0, 0, 0.4}}, .triangles = {{0, 2, 1}}}};
        default:
            return {make_plane(0.5)};
    }
}

inline Pose turned_further(const Pose& pose, double way, Random& random) {
    Pose next = pose;
    next.translation += random.point(way);
    next.rotation = random.rotation();
    return next;
}

/// Poses of the coming step: at rest every other one unless `moving`, in which case shifted and turned.
inline void set_poses(Steps& steps, bool moving, Random& random) {
    for (MovingMesh& o : steps.obstacles) {
        o.start = random.pose(0.05);
        o.end = moving ? turned_further(o.start, 0.05, random) : o.start;
    }
    if (steps.detector) steps.report_poses();
}

inline Steps make_steps(Scene scene, const TriangleMesh& cloth, const Backend& backend) {
    Steps steps{.cloth = cloth, .obstacles = {}, .detector = nullptr};
    for (TriangleMesh& mesh : meshes(scene)) steps.obstacles.push_back({.mesh = mesh, .start = {}, .end = {}});
    steps.start(backend.make_detector(), sheet_thickness);
    return steps;
}

inline std::vector<Vec3> shifted(const TriangleMesh& cloth, const Vec3& by, double noise, Random& random) {
    std::vector<Vec3> x;
    for (const Vec3& p : cloth.vertices) x.push_back(p + by + random.point(noise));
    return x;
}

inline TriangleMesh small_sheet() { return make_grid(0.4, 0.4, 5, 5); }

}  // namespace percale::test
