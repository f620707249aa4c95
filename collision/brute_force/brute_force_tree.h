#pragma once

#include "obstacle/obstacle_tree.h"

namespace percale {

/// Compares every box with every triangle; it is the reference for the trees.
std::unique_ptr<ObstacleTree> make_brute_force_tree(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
