#pragma once

#include <vector>

#include "derivative_check.h"
#include "substep/substep.h"

namespace percale {

/// The end of a step that was just solved.
struct StepEnd {
    const StepScene& scene;
    const ClothState& start;  // of the step
    const StepState& end;
    const Workspace& work;  // with the last evaluation
    double dt;              // s, of its substeps
};

/// Every force that acts on the cloth there, each by a function of checked_terms.cpp. Views the parts of `step`, which must not
/// change.
std::vector<CheckedTerm> checked_terms(const StepEnd& step);

/// Checks the derivatives of all of them; a misfit makes the step a failed one and is named in its report. Explicit schemes have
/// no matrix and no contact; their forces are still compared with energies.
void check_derivatives(const StepEnd& step, StepReport& report);

}  // namespace percale
