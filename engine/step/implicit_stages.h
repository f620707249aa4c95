#pragma once

#include "world.h"

namespace percale {

/// Moves the state over a span of the step by one step of the implicit scheme, and adds its estimated error of position to
/// world.stages.error if the settings are adaptive. With `go_on` a stage that has used up its iterations is followed by the next
/// one all the same. After a failure the state is that of some stage: restore_span_start.
NewtonEnd solve_implicit_span(World& world, StepFraction span, bool go_on);

/// The state as it was before solve_implicit_span.
void restore_span_start(World& world);

/// Work of pins and obstacles during the span just solved, J.
double span_work(World& world, StepFraction span);

}  // namespace percale
