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

/// Rest lengths of closing seams at the end of a part of the step; world.seam_work = what the change stores in them where they
/// are now, J.
void set_part_seams(World& world, StepFraction span);

/// Gives seams the rest lengths of a time within the step.
void set_seams_at(World& world, double fraction);

/// The air around cloth that lies at these positions, if there is any; null: none.
StepWind* set_wind_at(World& world, const Vectors& positions);

}  // namespace percale
