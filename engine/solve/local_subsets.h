#pragma once

#include "newton_stop.h"
#include "stage_equations.h"

namespace percale {

/// Nonlinear elimination (Cai and Keyes, SIAM Journal on Scientific Computing 24, 2002). Where contact or sticking begins or
/// ends, a few vertices hold most of the residual at space.current, and moves of all cloth are shortened because of them. These
/// vertices and their spring neighbours, the subset, are solved by a few Newton iterations, all others fixed; space.current is
/// then the result, direction and matrix are those of the subset. Returns false, and moves nothing, while pins or obstacles are
/// on their way, without contact, where the residual is spread, and where a cloth holds gas: its pressure joins all of the cloth.
bool solve_subsets(StageEquations& equations, const TimeError& error);

}  // namespace percale
