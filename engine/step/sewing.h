#pragma once

#include <span>

#include "percale/stitch.h"
#include "world.h"

namespace percale {

/// Appends to state.rest_length the lengths of springs that are new in the network, where the state has rest lengths of its own.
void add_rest_lengths(const SpringNetwork& network, std::vector<double>& rest_length);

/// Whether a stitch, in the numbers of the system, joins a vertex to itself.
bool joins_itself(const Stitch& stitch);

/// Called at the beginning of a step: welds of closed seams take up a fraction of the remaining gaps, and limited edges a
/// fraction of their excess length. Returns the work of that, J.
double tighten_holds(World& world);
/// Called after a failed step: restores the holds from before it.
void loosen_holds(World& world);

/// Adds a seam whose closing begins now; returns its number. The stitches have the numbers of the system.
int sew(World& world, std::span<const Stitch> stitches, const SeamSettings& settings);

}  // namespace percale
