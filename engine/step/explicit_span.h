#pragma once

#include "world.h"

namespace percale {

/// Moves the state over a span of the step by one step of the explicit scheme; adaptive ones by two half steps, whose distance to
/// the whole one tells the error, which is added to world.stages.error.
void solve_explicit_span(World& world, StepFraction span);

/// A state in which forces are taken: m, m/s; `air`: positions that the triangles have in the wind.
struct ForcePlace {
    const Vectors &positions, &velocities, &air;
};

/// world.explicit_space.forces at a state, without contact. Damping by velocity.
void evaluate_at(World& world, const ForcePlace& place);

/// f/m without contact, m/s^2; 0 at prescribed vertices.
void set_accelerations(World& world, const ClothState& state, Vectors& accelerations);

/// Work of moving pins and of the wind, J.
struct ScriptWork {
    double pins = 0.0, wind = 0.0;
};

/// That between a state and the present one, `length` in s later. Pins: what their kinetic energy gained less the work of the
/// mean of the forces (without contact) at both ends; wind: the mean of its powers there.
ScriptWork script_work(World& world, const ClothState& start, double length);

}  // namespace percale
