#pragma once

#include "span.h"

namespace percale {

/// One step of the explicit scheme over a span; adaptive ones by two half steps, whose distance to the whole one tells the error.
SpanResult advance_explicit(const Span& span, const StepState& start, Workspace& work, StepState& end);

}  // namespace percale
