#pragma once

#include <string_view>
#include <vector>

#include "percale/report.h"
#include "step/world.h"

namespace percale {

/// Makes the start clear: what the detector finds wrong is repaired (start_repair.h); returns what was moved, nothing where the
/// start was clear. Throws StartError, everything left as it was, where a pinned vertex is inside an obstacle, or the settings or
/// the shapes leave no repair. The world must have a detector. `verb`, with spaces about it: what messages say cloth does.
std::vector<StartMove> clear_start(World& world, std::string_view verb);

}  // namespace percale
