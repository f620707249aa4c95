#pragma once

#include <span>
#include <vector>

#include "model/vec3_arrays.h"
#include "percale/stitch.h"

namespace percale {

/// A welded stitch holds by a force h on its two sides, besides its spring. h replaces the spring's k u, u the gap between the
/// sides, so that at rest no gap is left. It is a multiplier of the constraint u = 0; each step adds a fraction of k u (method
/// of multipliers: Hestenes 1969, Multiplier and gradient methods). It stores h . u, which is zero where u is.
struct Weld {
    Stitch stitch;             // in the numbers of the system
    double stiffness = 0.0;    // k of its spring, N/m
    Vec3 hold = Vec3::Zero();  // h, N
};

/// Energy of all, J.
double weld_energy(std::span<const Weld> welds, const Vec3Arrays& positions);

/// Adds `fraction` k u to the hold of each of some welds, up to k times `widest`, m. Returns the increase of their energy, J.
double tighten(std::span<Weld> welds, const Vec3Arrays& positions, double fraction, double widest);

}  // namespace percale
