#pragma once

#include <algorithm>

#include "tolerances.h"

namespace percale {

/// Fraction of a distance below clamp_floor / clamp_remainder (0.4 h) that a clamp leaves. Towards 1: a vertex that is near can
/// hardly come nearer in one call. Towards 0: one call may use up what the following ones need.
inline constexpr double clamp_remainder = 0.5;

/// Fraction of h. No clamp leaves less, unless less was there. 0: distances halve until rounding decides.
inline constexpr double min_clamp_floor = 1e-3;

/// Fraction of a distance below min_clamp_floor that a clamp leaves. 1: such a vertex could not move at all.
inline constexpr double min_clamp_remainder = 0.999;

/// The distance that a clamp leaves of a distance d, m: a fifth of the thickness h for d above 0.4 h, half of d below, but never
/// less than h/1000 unless d itself is below (tolerances.h). Without a floor distances collapse to rounding, where directions are
/// lost; a fixed floor would lock vertices.
inline double floor_below(double d, double h) {
    using namespace tolerances;
    if (d > clamp_floor / clamp_remainder * h) return clamp_floor * h;
    return d > min_clamp_floor * h ? std::max(clamp_remainder * d, min_clamp_floor * h) : min_clamp_remainder * d;
}

/// The distance, m, above which pairs keep their floor if they come closer by no more than `displacement`, m.
inline double distance_that_keeps_floor(double displacement, double h) {
    using namespace tolerances;
    const bool keeps_all = displacement > (1.0 / clamp_remainder - 1.0) * clamp_floor * h;
    return keeps_all ? displacement + clamp_floor * h
                     : std::max(displacement / (1.0 - clamp_remainder), displacement + min_clamp_floor * h);
}

}  // namespace percale
