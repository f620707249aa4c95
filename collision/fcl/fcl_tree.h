#pragma once

#include "obstacle/obstacle_tree.h"

namespace percale {

/// FCL's tree of axis-parallel boxes; it finds exactly the triangles whose boxes overlap the queried one.
std::unique_ptr<ObstacleTree> make_fcl_tree(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
