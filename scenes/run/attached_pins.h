#pragma once

#include <optional>
#include <span>
#include <vector>

#include "format/scene.h"
#include "percale/surface_point.h"

namespace percale::scenes {

/// A pinned vertex that keeps its place on an obstacle (pin.to).
struct AttachedPin {
    int cloth = 0, vertex = 0;
    int obstacle = 0;
    Vec3 place = Vec3::Zero();            // m, in a rigid obstacle's mesh, unit applied, pose not
    std::optional<SurfacePoint> on = {};  // of one that bends: it goes along with the nearest triangle
};

/// All of a scene, as its cloths and obstacles start (cloths in world coordinates, obstacles in those of their mesh, both in the
/// order of the scene). Throws SceneError with the place of `pin` where there is no such obstacle.
std::vector<AttachedPin> attached_pins(const Scene& scene, std::span<const TriangleMesh> cloth_meshes,
                                       std::span<const TriangleMesh> obstacle_meshes);

/// Where such a pin is at a time, m, world. `shape`: the vertices of its obstacle then, before the pose; not read if it is rigid.
Vec3 place_at(const AttachedPin& pin, const Scene& scene, std::span<const Vec3> shape, double time);

}  // namespace percale::scenes
