#pragma once

#include "newton_stop.h"
#include "stage_equations.h"

namespace percale {

/// What a linear solve came to; the direction itself, m/s, is in the work space.
struct Direction {
    int linear_iterations = 0;
    bool exact = true;  // the solver got where it should
};

/// The Newton direction dv at space.current: A dv = -r with the matrix A of linear/block_matrix.h, M without
/// Jacobians; prescribed vertices head for their targets, contact foresees what obstacles have still to go. With `foreseen`, A
/// and r are those with its rows, too, which must be of a move from space.current.
Direction newton_direction(const StageEquations& equations, const SolveTarget& target, const ForeseenRows* foreseen = nullptr);

/// dv by one application of the preconditioner alone, an estimate that is far cheaper; false where that is no good one.
bool estimate_direction(const StageEquations& equations);

}  // namespace percale
