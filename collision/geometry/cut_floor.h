#pragma once

#include <algorithm>

namespace percale {

constexpr double largest_floor = 0.2;  // of the thickness

/// The distance a cut leaves of a distance d, m: a fifth of the thickness h for d above 0.4 h, half of d below, but never less
/// than h/1000 unless d itself is there. Without a floor distances collapse to rounding, where directions are lost; a fixed floor
/// would lock vertices.
inline double floor_below(double d, double h) {
    if (d > 2.0 * largest_floor * h) return largest_floor * h;
    return d > 1e-3 * h ? std::max(0.5 * d, 1e-3 * h) : 0.999 * d;
}

}  // namespace percale
