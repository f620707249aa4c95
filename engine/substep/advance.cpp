#include "advance.h"

#include "explicit_substep.h"
#include "implicit_substep.h"

namespace percale {

SubstepResult advance(const Substep& substep, const StepState& start, Workspace& work, StepState& end) {
    return substep.scene.plan.implicit ? advance_implicit(substep, start, work, end)
                                       : advance_explicit(substep, start, work, end);
}

}  // namespace percale
