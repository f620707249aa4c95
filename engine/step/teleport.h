#pragma once

#include <span>

#include "world.h"

namespace percale {

/// Moves cloths and obstacles, by their numbers, by a rigid motion of the world, and with them all vectors that steps remember.
/// Cloth releases stick anchors and impacts on bodies that do not go along. `keep`: velocities turn with the cloth, else it
/// stops.
void teleport(World& world, std::span<const int> cloths, std::span<const int> obstacles, const Pose& motion, bool keep);

}  // namespace percale
