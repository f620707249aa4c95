#pragma once

#include <vector>

#include "forces/total_force.h"
#include "model/cloth_model.h"

namespace percale {

/// One explicit step. Prescribed vertices move straight to their targets.
struct ExplicitPart {
    const Compute* compute = nullptr;
    const ClothModel* model = nullptr;
    const StepSettings* settings = nullptr;
    const Vectors* targets = nullptr;             // m, where prescribed vertices are at the end
    const AlignedVector<double>* free = nullptr;  // 1 for free vertices, 0 for prescribed ones and padding
    double dt = 0.0;                              // s
    StepWind* wind = nullptr;                     // null: no air
};

struct ExplicitSpace {
    StepSprings springs;
    Forces forces;
    ClothState stage;
    Vectors acceleration, velocity_sum, acceleration_sum;
    AlignedVector<double> mobility;  // 1/kg, 0 where prescribed
    Vectors start_forces;            // N, for the work of pins
};

/// One step of an explicit scheme. Damping by velocity; velocities of free vertices v, accelerations a(q, v) = f/m.
/// forward_euler:    q' = q + dt v, v' = v + dt a(q, v)
/// symplectic_euler: v' = v + dt a(q, v), q' = q + dt v'
/// midpoint:         the slopes at q + dt/2 v, v + dt/2 a
/// rk4:              classical Runge-Kutta of order 4
void step_explicit(Scheme scheme, const ExplicitPart& part, ExplicitSpace& space, ClothState& state);

}  // namespace percale
