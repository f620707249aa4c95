#pragma once

#include "world.h"

namespace percale {

/// Makes a step as `parts` equal ones one after the other: obstacles translate and turn by equal fractions, pins move straight
/// on, or with an obstacle that carries them to their targets. Its report combines theirs. Where one of them fails, everything
/// is as it was before the first, and the report is that part's, with the work of the others. `step_once` makes one part.
StepReport step_in_parts(World& world, int parts, StepReport (*step_once)(World&));

/// Adds to a report the other work for its step: iterations, dropped substeps, CPU times.
void add_work(const StepReport& other, StepReport& report);

}  // namespace percale
