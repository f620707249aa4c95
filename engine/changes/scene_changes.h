#pragma once

#include "remake.h"
#include "step/world.h"

namespace percale {

/// Takes cloth, what pairs say of it and its seams out. Returns the numbers before of the seams that are left.
std::vector<int> drop_cloth(World& world, int cloth);

/// Gives a cloth another fabric. Throws SceneError, and leaves all as it was, where it cannot have it.
void change_fabric(World& world, int cloth, const Fabric& fabric);

/// Takes an obstacle out; later ones have numbers less by one. Throws SceneError where the detector cannot. Cloth wakes up only
/// if the obstacle touched some.
void drop_obstacle(World& world, int obstacle);

}  // namespace percale
