#pragma once

#include <span>

#include "percale/stitch.h"
#include "world.h"

namespace percale {

/// state.rest_length: of springs that are new in the network, where the state has rest lengths of its own.
void add_rest_lengths(const SpringNetwork& network, std::vector<double>& rest_length);

/// Whether a stitch, in the numbers of the system, joins a vertex to itself.
bool joins_itself(const Stitch& stitch);

/// At the beginning of a step: welds of closed seams take up a share of the gaps that are left, and limited edges of what they
/// are too long. Returns the work of that, J.
double tighten_holds(World& world);
/// After a step that failed: as before it.
void loosen_holds(World& world);

/// Adds a seam whose closing begins now; returns its number. The stitches have the numbers of the system.
int sew(World& world, std::span<const Stitch> stitches, const SeamSettings& settings);

}  // namespace percale
