#pragma once

#include "newton_stop.h"
#include "stage_equations.h"

namespace percale {

/// The result of a linear solve; the direction itself, m/s, is in the work space.
struct Direction {
    int linear_iterations = 0;
    bool exact = true;  // the solver reached its target
};

/// The Newton direction dv at space.current: A dv = -r with the matrix A of linear/block_matrix.h, which is M without Jacobians.
/// Prescribed vertices move to their targets, and contact accounts for the motion that is left to obstacles. With
/// `trial_contacts`, which must be of a move from space.current, A and r include them.
Direction newton_direction(const StageEquations& equations, const SolveTarget& target,
                           const TrialContacts* trial_contacts = nullptr);

/// Sets dv by one application of the preconditioner alone, an estimate that is far cheaper; false where that is no good one.
bool estimate_direction(const StageEquations& equations);

}  // namespace percale
