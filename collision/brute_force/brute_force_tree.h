#pragma once

#include "obstacle/obstacle_tree.h"

namespace percale {

/// Every box against every triangle; the standard the trees are held to.
std::unique_ptr<ObstacleTree> make_brute_force_tree(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
