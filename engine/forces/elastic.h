#pragma once

#include "model/cloth_state.h"
#include "total_force.h"

namespace percale {

/// Energy of all terms that count as elastic, J: springs, hinges, membranes, enclosed gas. `rest_length`:
/// ClothState::rest_length.
double elastic_energy(const ClothModel& model, const Vec3Arrays& positions, std::span<const double> rest_length);

/// Work space for elastic forces.
struct ElasticSpace {
    StepSprings springs;
    Forces forces;
    Vec3Arrays still;  // velocities of 0
};

/// space.forces.total = the forces of those terms, N.
void evaluate_elastic(const Compute& compute, const ClothModel& model, const ClothState& state, ElasticSpace& space);

/// A straight move, with the positions at which a scheme took the forces for it, m, and the springs' rest lengths there.
struct ShapeMove {
    const Vec3Arrays &start, &end, &positions;
    std::span<const double> rest_length;
};

/// Whether there are such terms besides springs.
bool has_shapes(const ClothModel& model);

/// Bregman term of the energy U of those terms for the force f that the scheme took, -f . (q_end - q_start) - (U(q_end) -
/// U(q_start)), J; 0 if there are none.
double shape_loss(const Compute& compute, const ClothModel& model, const ShapeMove& move, ElasticSpace& space);

}  // namespace percale
