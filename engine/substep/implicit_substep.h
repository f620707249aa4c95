#pragma once

#include "substep.h"

namespace percale {

/// One step of the implicit scheme over a substep: its stages, one nonlinear system each.
SubstepResult advance_implicit(const Substep& substep, const StepState& start, Workspace& work, StepState& end);

}  // namespace percale
