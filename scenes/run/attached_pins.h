#pragma once

#include <span>
#include <vector>

#include "format/scene.h"

namespace percale::scenes {

/// A pinned vertex that keeps its place on an obstacle (pin.to).
struct AttachedPin {
    int cloth = 0, vertex = 0;
    int obstacle = 0;
    Vec3 place = Vec3::Zero();  // m, in the obstacle's mesh, unit applied, pose not
};

/// All of a scene, as its cloths start (in world coordinates, in the order of scene.cloths). Throws SceneError with the place of
/// `pin` where there is no such obstacle, or it is not rigid.
std::vector<AttachedPin> attached_pins(const Scene& scene, std::span<const TriangleMesh> cloth_meshes);

/// Where such a pin is at a time, m, world.
Vec3 place_at(const AttachedPin& pin, const Scene& scene, double time);

}  // namespace percale::scenes
