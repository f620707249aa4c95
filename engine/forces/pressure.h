#pragma once

#include "force_term.h"

namespace percale {

/// The volume inside a closed cloth by the divergence theorem, m^3: the sum over its triangles (a, b, c) of a . (b x c)/6,
/// positive where they are counter-clockwise seen from outside.
double volume_of(const ClothModel& model, const ClothRange& cloth, const Vec3Arrays& positions);

/// sum += factor dV/dx, m^2, with an entry for each vertex of the cloth: (b - a) x (c - a)/6 at each corner of a triangle.
void add_volume_gradient(const ClothModel& model, const ClothRange& cloth, const Vec3Arrays& positions, double factor,
                         std::span<Vec3> sum);

/// The gas inside a closed cloth at a volume V.
struct GasState {
    double pressure;   // Pa, p = -dU/dV, above the air outside
    double energy;     // J, U
    double stiffness;  // Pa/m^3, d^2U/dV^2
};
/// Fabric::pressure, a given difference: U = -p V. Fabric::gas_volume, an amount of gas that takes up V_0 at the pressure p_0 of
/// the air, at a steady temperature (Boyle's law): p = p_0 (V_0/V - 1), U = p_0 V_0 (d - ln(1 + d)) with d = V/V_0 - 1, infinite,
/// and p not a number, where V <= 0.
GasState gas_state_at(const Fabric& fabric, double volume);

/// Pushes each vertex by p dV/dx. The matrix has all of its derivative: without p d^2V/dx^2, which cancels a part of the cloth's
/// tension, a ball would resist rotation.
const ForceTerm& pressure_term();

}  // namespace percale
