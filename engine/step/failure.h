#pragma once

#include "motion.h"
#include "span/span.h"

namespace percale {

/// A span failed for good: the report's status, and which pin and which obstacles are in the way where something is.
void tell_failure(const StepScene& scene, SpanEnd end, const Workspace& work, StepReport& report);

/// A span that did not converge is kept: the report's status, and the cloth that its pins hold back where there is one.
void tell_unsolved(const StepScene& scene, const Workspace& work, StepReport& report);

/// A step that is not tried, since an obstacle or a pin moves too far in it.
void tell_too_far(const StepScene& scene, const MotionParts& motion, StepReport& report);

}  // namespace percale
