#pragma once

#include "substep/substep.h"

namespace percale {

/// Solves the whole step from `start`: an explicit update, or an implicit one in one substep, or in halves where one does not
/// converge or cannot follow pins and obstacles; adaptive steps in as many substeps as their tolerance requires. Sets the
/// report's status and figures. Returns the end of the step, which is in the workspace until the next one; null if the step
/// failed.
StepState* solve_step(const StepScene& scene, const StepState& start, Workspace& work, StepReport& report);

}  // namespace percale
