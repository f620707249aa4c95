#pragma once

#include "span.h"

namespace percale {

/// One step of the implicit scheme over a span: its stages, one nonlinear system each.
SpanResult advance_implicit(const Span& span, const StepState& start, Workspace& work, StepState& end);

}  // namespace percale
