#pragma once

#include "world.h"

namespace percale {

/// A straight move, with the positions at which a scheme took the forces for it, m.
struct ShapeMove {
    const Vectors &start, &end, &positions;
};

/// Elastic energy of springs, hinges and membranes, J.
double shape_energy(const ClothModel& model, const Vectors& positions);

/// space.forces.total = elastic forces of springs, hinges and membranes, N. `still`: velocities of 0.
void evaluate_elastic(const World& world, const Vectors& positions, const Vectors& still, ExplicitSpace& space);

/// Bregman term of the energy U of hinges and membranes for the force f that the scheme took, -f . (q_end - q_start) - (U(q_end)
/// - U(q_start)), J; 0 without such.
double shape_loss(World& world, const ShapeMove& move);

}  // namespace percale
