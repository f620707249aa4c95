#pragma once

#include <vector>

#include "derivative_check.h"
#include "world.h"

namespace percale {

/// Every force that acts on the cloth at the end of a step that was just solved, one function of checked_terms.cpp each. Views
/// the world, which must stay as it is.
std::vector<CheckedTerm> checked_terms(const World& world);

/// Checks the derivatives of all of them; what does not fit makes the step a failed one and stands in its report. Explicit
/// schemes have no matrix and no contact; their forces are compared with energies all the same.
void check_derivatives(World& world);

}  // namespace percale
