#pragma once

#include <span>

#include "force_term.h"

namespace percale {

/// Every force but contact, in the order in which they are summed.
std::span<const ForceTerm* const> force_terms();

/// The sum of all of them.
void evaluate_forces(const ForceInput& input, Forces& forces);

}  // namespace percale
