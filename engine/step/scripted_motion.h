#pragma once

#include "world.h"

namespace percale {

/// Brings the plan up to date and tells the detector where obstacles are at the ends of the coming step, where it does not know
/// it yet.
void set_targets(World& world);

/// After a good step: obstacles stay where they arrived.
void finish_motion(World& world);

/// world.part_targets: where pins are after the given fraction of the step, on the straight line from its start.
void set_part_targets(World& world, double fraction);

}  // namespace percale
