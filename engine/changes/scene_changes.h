#pragma once

#include "remake.h"
#include "step/world.h"

namespace percale {

/// Removes a cloth, its pair settings and its seams. Returns the earlier numbers of the remaining seams.
std::vector<int> drop_cloth(World& world, int cloth);

/// Gives a cloth another fabric. Throws SceneError, and leaves everything as it was, where the cloth cannot have it.
void change_fabric(World& world, int cloth, const Fabric& fabric);

/// Removes an obstacle; the numbers of later ones decrease by one. Throws SceneError where the detector cannot remove it. Cloth
/// wakes up only if the obstacle touched some.
void drop_obstacle(World& world, int obstacle);

}  // namespace percale
