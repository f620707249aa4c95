#pragma once

#include "obstacle/obstacle_tree.h"

namespace percale {

/// Bullet's quantized tree; finds some triangles more than those asked for.
std::unique_ptr<ObstacleTree> make_bullet_tree(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
