#pragma once

#include "obstacle/obstacle_tree.h"

namespace percale {

/// Bullet's quantized tree; it finds some triangles beyond those whose boxes overlap the queried one.
std::unique_ptr<ObstacleTree> make_bullet_tree(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
