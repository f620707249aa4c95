#pragma once

#include "span/span.h"

namespace percale {

/// A span failed for good: the report's status, and which pin and which obstacles are in the way where something is.
void tell_failure(const StepScene& scene, SpanEnd end, const Workspace& work, StepReport& report);

}  // namespace percale
