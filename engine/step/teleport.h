#pragma once

#include <span>

#include "world.h"

namespace percale {

/// Moves cloths and obstacles, by their numbers, by a rigid motion of the world, and with them all that steps remember in its
/// directions. What cloth holds on to that does not go along, it lets go. `keep`: velocities turn with the cloth, else it stops.
void teleport(World& world, std::span<const int> cloths, std::span<const int> obstacles, const Pose& motion, bool keep);

}  // namespace percale
