#pragma once

#include "motion.h"
#include "substep/substep.h"

namespace percale {

/// A substep failed for good: sets the report's status, and which pin and which obstacles are in the way where something is.
void report_failure(const StepScene& scene, SubstepOutcome end, const Workspace& work, StepReport& report);

/// A substep that did not converge is kept: sets the report's status, and the cloth that its pins hold back where there is one.
void report_unsolved(const StepScene& scene, const Workspace& work, StepReport& report);

/// Reports a step that is not tried, since an obstacle or a pin moves too far in it.
void report_too_far(const StepScene& scene, const MotionParts& motion, StepReport& report);

}  // namespace percale
