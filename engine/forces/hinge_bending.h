#pragma once

#include "force_term.h"
#include "model/hinges.h"
#include "model/vec3_arrays.h"

namespace percale {

/// Energy of all hinges, J: 1/2 c |u|^2 of flat ones, 1/2 c (theta - rest angle)^2 of curved ones.
double hinge_energy(const Hinges& hinges, const Vec3Arrays& positions);

/// Pairs (network.bending) make every hinge a flat one. This adds the difference to hinges with a rest angle for the curved
/// ones: forces, N, += the difference; returns the change of their energy, J. Their matrix stays that of flat ones, c w w^T,
/// which is positive definite and exact for motion along the normals of a shape whose rest angles are small.
double add_curved_hinges(const Hinges& hinges, const Vec3Arrays& positions, Vec3Arrays& forces);

/// The springs hold the flat part of hinges (SpringNetwork::bending).
const ForceTerm& hinge_term();

}  // namespace percale
