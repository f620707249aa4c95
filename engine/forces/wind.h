#pragma once

#include <vector>

#include "contact/penalty.h"
#include "model/cloth_model.h"

namespace percale {

/// One triangle in the air, as it lay when the part of a step began.
struct WindTriangle {
    Vec3 normal = Vec3::Zero();  // unit; zero if it has no area
    double area = 0.0;           // m^2
};

/// Air around all cloth during one part of a step.
struct StepWind {
    bool blows = false;                   // false: there is no air, nothing else is set
    Vec3 velocity = Vec3::Zero();         // m/s
    double density = 0.0;                 // kg/m^3
    std::vector<WindTriangle> triangles;  // in the order of the model's
};

/// What the wind leaves behind besides forces.
struct WindTerms {
    double power = 0.0;                  // W, of the air on the cloth
    double potential = 0.0;              // J, dt times the dissipation potential
    std::vector<SymmetricBlock> blocks;  // kg, -dt Jv of each vertex
};

/// Takes the triangles as they lie now.
void set_step_wind(const ClothModel& model, const Vec3& velocity, double density, const Vectors& positions, StepWind& wind);

/// Drag of a surface that moves with u against the air, u = u_n n + u_t:
///     f = -1/2 rho A (C_n |u_n| u_n n + C_t |u_t| u_t),
/// at each corner with the corner's velocity and its share of the area (that of its mass). With A and n kept through the step it
/// is -d/dv of 1/6 rho A (C_n |u_n|^3 + C_t |u_t|^3), which is convex: -Jv is positive semidefinite and backward Euler's
/// incremental potential stays one. forces += f, N.
void add_wind(const ClothModel& model, const StepWind& wind, const Vectors& velocities, double dt, Vectors& forces,
              WindTerms& terms);

/// Puts the terms' blocks in front of those of contact, which keeps them there (ContactTerms::others).
void set_wind_blocks(const WindTerms& terms, ContactTerms& contact);

}  // namespace percale
