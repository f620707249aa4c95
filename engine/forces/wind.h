#pragma once

#include "force_term.h"
#include "model/cloth_model.h"

namespace percale {

/// Stores the triangles as they lie now.
void set_step_wind(const ClothModel& model, const Vec3& velocity, double density, const Vec3Arrays& positions, StepWind& wind);

struct WindPower {
    double power = 0.0;      // W, of the air on the cloth
    double potential = 0.0;  // J, dt times the dissipation potential
};

/// Drag of a surface that moves with u against the air, u = u_n n + u_t:
///     f = -1/2 rho A (C_n |u_n| u_n n + C_t |u_t| u_t),
/// at each corner with the corner's velocity and its part of the area (that of its mass). With A and n kept through the step it
/// is -d/dv of 1/6 rho A (C_n |u_n|^3 + C_t |u_t|^3), which is convex: -Jv is positive semidefinite and backward Euler's
/// incremental potential stays one. forces += f, N; appends a block of -dt Jv, kg, for each vertex, unless `blocks` is null.
WindPower add_wind(const ClothModel& model, const StepWind& wind, const Vec3Arrays& velocities, double dt, Vec3Arrays& forces,
                   std::vector<CoupledBlock>* blocks);

const ForceTerm& wind_term();

}  // namespace percale
