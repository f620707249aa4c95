#include "advance.h"

#include "explicit_span.h"
#include "implicit_span.h"

namespace percale {

SpanResult advance(const Span& span, const StepState& start, Workspace& work, StepState& end) {
    return span.scene.plan.implicit ? advance_implicit(span, start, work, end) : advance_explicit(span, start, work, end);
}

}  // namespace percale
