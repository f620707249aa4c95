#pragma once

#include <vector>

#include "derivative_check.h"
#include "span/span.h"

namespace percale {

/// The end of a step that was just solved.
struct StepEnd {
    const StepScene& scene;
    const ClothState& start;  // of the step
    const StepState& end;
    const Workspace& work;  // with the last evaluation
    double dt;              // s, of its spans
};

/// Every force that acts on the cloth there, one function of checked_terms.cpp each. Views what the end names, which must stay as
/// it is.
std::vector<CheckedTerm> checked_terms(const StepEnd& step);

/// Checks the derivatives of all of them; what does not fit makes the step a failed one and stands in its report. Explicit
/// schemes have no matrix and no contact; their forces are compared with energies all the same.
void check_derivatives(const StepEnd& step, StepReport& report);

}  // namespace percale
