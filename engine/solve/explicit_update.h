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
    Vectors stage_velocities;  // of the stage before, while the next is made
    Vectors start_forces;      // N, for the work of pins
};

/// Symplectic (semi-implicit) Euler: v' = v + dt f(q, v)/m, q' = q + dt v'. Damping by velocity.
void step_symplectic_euler(const ExplicitPart& part, ExplicitSpace& space, ClothState& state);

/// Classical Runge-Kutta of order 4 on (q, v). Damping by velocity.
void step_rk4(const ExplicitPart& part, ExplicitSpace& space, ClothState& state);

}  // namespace percale
