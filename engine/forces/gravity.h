#pragma once

#include <span>

#include "force_term.h"

namespace percale {

/// forces = m g on every vertex (replaces earlier values). Mass in kg, gravity in m/s^2.
void set_gravity_forces(const Compute& compute, std::span<const double> mass, const Vec3& gravity, Vec3Arrays& forces);

/// -sum m g . x, J; zero at the origin.
double gravity_energy(const Compute& compute, std::span<const double> mass, const Vec3& gravity, const Vec3Arrays& positions);

/// The first term of the list: its forces replace earlier values.
const ForceTerm& gravity_term();

}  // namespace percale
