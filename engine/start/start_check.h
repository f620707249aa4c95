#pragma once

#include <string_view>
#include <vector>

#include "percale/report.h"
#include "step/world.h"

namespace percale {

/// Makes the start clear by resolving the initial penetration that the detector finds (start_repair.h); returns the moved
/// vertices, none where the start was clear. Throws StartError, everything left as it was, where a pinned vertex is inside an
/// obstacle, or the settings or the shapes allow no resolution. The world must have a detector. `verb`, with spaces about it:
/// what messages state that cloth does.
std::vector<StartMove> clear_start(World& world, std::string_view verb);

}  // namespace percale
