#pragma once

#include "newton_stop.h"
#include "stage_equations.h"

namespace percale {

/// Nonlinear elimination (Cai and Keyes, SIAM Journal on Scientific Computing 24, 2002). Where cloth begins or ceases to stick or
/// to touch, a few vertices hold most of the residual at space.current, and moves of all cloth are cut short for their sake.
/// These vertices and those that springs join to them, the patches, are solved for alone by a few Newton iterations, all others
/// held; space.current is then where that led. False, and nothing done, where there is no contact, where the residual is spread
/// over more vertices, and where a cloth is filled: its pressure joins all of its vertices.
bool relax_patches(StageEquations& equations, const TimeError& error);

}  // namespace percale
