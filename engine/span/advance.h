#pragma once

#include "span.h"

namespace percale {

/// Advances the cloth over a span from `start` by one step of the scheme; `end` is where it leads, defined if the result is
/// usable.
SpanResult advance(const Span& span, const StepState& start, Workspace& work, StepState& end);

}  // namespace percale
