#pragma once

#include "world.h"

namespace percale {

/// Moves the state over a span of the step by one step of the explicit scheme; adaptive ones by two half steps, whose distance to
/// the whole one tells the error, which is added to world.stages.error.
void solve_explicit_span(World& world, StepFraction span);

/// f/m without contact, m/s^2; 0 at prescribed vertices.
void set_accelerations(World& world, const ClothState& state, Vectors& accelerations);

/// Work of moving pins between a state and the present one, J: what their kinetic energy gained less the work of the mean of the
/// forces (without contact) at both ends.
double pin_work(World& world, const ClothState& start);

}  // namespace percale
