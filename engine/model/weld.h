#pragma once

#include <span>
#include <vector>

#include "model/vectors.h"
#include "percale/stitch.h"

namespace percale {

/// What a welded stitch holds with besides its spring: a force h on the two sides that takes the place of the spring's k u, u the
/// gap between them, so that at rest no gap is left. It is a multiplier of the constraint u = 0; each step adds a share of k u
/// (method of multipliers: Hestenes 1969, Multiplier and gradient methods). It stores h . u, which is nothing where u is.
struct Weld {
    Stitch stitch;             // in the numbers of the system
    double stiffness = 0.0;    // k of its spring, N/m
    Vec3 hold = Vec3::Zero();  // h, N
};

/// Energy of all, J.
double weld_energy(std::span<const Weld> welds, const Vectors& positions);

/// Adds share k u to what each of some welds holds with, up to k times `widest`, m. Returns what their energy grows by, J.
double tighten(std::span<Weld> welds, const Vectors& positions, double share, double widest);

}  // namespace percale
