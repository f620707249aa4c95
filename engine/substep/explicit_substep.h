#pragma once

#include "substep.h"

namespace percale {

/// One step of the explicit scheme over a substep; adaptive ones make two half steps and a whole one, whose distance gives the
/// error.
SubstepResult advance_explicit(const Substep& substep, const StepState& start, Workspace& work, StepState& end);

}  // namespace percale
