#pragma once

#include <span>
#include <vector>

#include "forces/total_force.h"
#include "plan/scene.h"

namespace percale {

/// One explicit step. Prescribed vertices move straight to their targets.
struct ExplicitStep {
    const StepScene& scene;
    const Vec3Arrays& targets;                 // m, of prescribed vertices at the end
    double dt;                                 // s
    StepWind* wind = nullptr;                  // null: no air; it is set anew at each stage
    std::span<const double> rest_length = {};  // m, ClothState::rest_length in the middle of the step
};

struct ExplicitSpace {
    StepSprings springs;
    Forces forces;
    ClothState stage;
    Vec3Arrays acceleration, velocity_sum, acceleration_sum;
    AlignedVector<double> mobility;  // 1/kg, 0 where prescribed
    Vec3Arrays start_forces;         // N, for the work of pins
};

/// One step of an explicit scheme. Damping by velocity; velocities of free vertices v, accelerations a(q, v) = f/m.
/// forward_euler:    q' = q + dt v, v' = v + dt a(q, v)
/// symplectic_euler: v' = v + dt a(q, v), q' = q + dt v'
/// midpoint:         the slopes at q + dt/2 v, v + dt/2 a
/// rk4:              classical Runge-Kutta of order 4
void step_explicit(Scheme scheme, const ExplicitStep& step, ExplicitSpace& space, ClothState& state);

}  // namespace percale
