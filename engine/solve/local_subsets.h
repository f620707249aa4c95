#pragma once

#include "direction.h"
#include "newton_stop.h"
#include "subset_space.h"
#include "support/deadline.h"

namespace percale {

/// What the nonlinear elimination of a subset works on. Afterwards direction, matrix and trial are those of the subset.
struct SubsetTask {
    const TimeError& error;
    BodyStates& bodies;
    NewtonSystem& system;
    Direction& direction;
    const TimeBudget& time;
};

/// Nonlinear elimination (Cai and Keyes, SIAM Journal on Scientific Computing 24, 2002). Where contact or sticking begins or
/// ends, a few vertices hold most of the residual at a point, and moves of all cloth are shortened because of them. These
/// vertices and their spring neighbours, the subset, are solved by a few Newton iterations, all others fixed; `current` is then
/// the result. Returns false, and moves nothing, while pins or obstacles are on their way, without contact, where the residual
/// is spread, and where a cloth is under pressure, which joins all of it. `trial`: work space.
bool solve_subsets(StageEquations& equations, const SubsetTask& task, SubsetSpace& space, StagePoint& current, StagePoint& trial);

}  // namespace percale
