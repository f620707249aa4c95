#pragma once

#include <span>

#include "force_term.h"

namespace percale {

/// forces = m g on every vertex (replaces what was there). Mass in kg, gravity in m/s^2.
void set_gravity_forces(const Compute& compute, std::span<const double> mass, const Vec3& gravity, Vectors& forces);

/// -sum m g . x, J; zero at the origin.
double gravity_energy(const Compute& compute, std::span<const double> mass, const Vec3& gravity, const Vectors& positions);

/// The first term of the list: its forces replace what was there.
const ForceTerm& gravity_term();

}  // namespace percale
