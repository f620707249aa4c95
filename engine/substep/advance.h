#pragma once

#include "substep.h"

namespace percale {

/// Advances the cloth over a substep from `start` by one step of the scheme; `end` is the resulting state, defined if the result
/// is usable.
SubstepResult advance(const Substep& substep, const StepState& start, Workspace& work, StepState& end);

}  // namespace percale
