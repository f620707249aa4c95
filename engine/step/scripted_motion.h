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

/// Rest lengths of closing seams at a place of the span world.part.
void set_seams_at(World& world, double place);

/// Work of closing seams in the span world.part, from the positions `start` to the present ones, J: each stage's share of what
/// the change of length to its own stores at the start, and of what the change from there stores at the end. Leaves the seams as
/// they are at the end.
double seam_work(World& world, const Vectors& start);

/// The air around cloth that lies at these positions, if there is any; null: none.
StepWind* set_wind_at(World& world, const Vectors& positions);

}  // namespace percale
