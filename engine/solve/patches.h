#pragma once

#include "newton_stop.h"
#include "stage_equations.h"

namespace percale {

/// Nonlinear elimination (Cai and Keyes, SIAM Journal on Scientific Computing 24, 2002). Where cloth begins or ceases to stick or
/// to touch, a few vertices hold most of the residual at space.current, and moves of all cloth are cut short for their sake.
/// These vertices and those that springs join to them, the patches, are solved for alone by a few Newton iterations, all others
/// held; space.current is then where that led, direction and matrix are theirs. False, and nothing moved, where pins or obstacles
/// are on their way, without contact, where the residual is spread, and where a cloth is filled: its pressure joins all of it.
bool relax_patches(StageEquations& equations, const TimeError& error);

}  // namespace percale
