#pragma once

#include "world.h"

namespace percale {

/// A step as so many equal ones one after the other: obstacles go by even shares of their way
/// and of their turn, pins straight on, or with an obstacle
/// that takes them where they are to be. Its report is theirs together. Where one of them fails, everything is as it was before
/// the first, and the report is that step's, with what the others did. `step_once` makes one.
StepReport step_in_parts(World& world, int parts, StepReport (*step_once)(World&));

/// Adds to a report what else was done for its step: iterations, dropped spans, CPU times.
void add_work(const StepReport& other, StepReport& report);

}  // namespace percale
