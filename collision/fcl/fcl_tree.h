#pragma once

#include "obstacle/obstacle_tree.h"

namespace percale {

/// FCL's tree of axis-parallel boxes; finds no triangle more than those asked for.
std::unique_ptr<ObstacleTree> make_fcl_tree(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
