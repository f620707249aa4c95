#pragma once

#include <array>

#include "percale/mesh.h"

namespace percale {

/// Four points moving on straight lines over one unit of time: a point and a triangle, or two edges.
struct MovingFour {
    std::array<Vec3, 4> from, to;
};

enum class PairShape { point_triangle, edge_edge };  // point 0 against 1 2 3; 0 1 against 2 3

/// A time in [0, latest] up to which the distance is proven to stay above `floor` (m, below the distance at the start): `latest`
/// if that holds throughout, else a time at which little more than a tenth of the starting clearance is left, or an earlier one
/// where a clearance that is tiny against the displacement would take more than 500 advances. Additive conservative advancement
/// with thickness (Li, Kaufman and Jiang 2021): it solves for no roots, hence it misses no coplanar or parallel hits.
double time_of_impact_lower_bound(const MovingFour& four, PairShape shape, double floor, double latest);

/// m, what rounding may add to or take from a distance of two features at these coordinates. A floor below it proves nothing.
double rounding_floor(const MovingFour& four);

/// The distance that a clamp leaves of `distance`, m: the larger of `floor_below` and `rounding_floor`.
double clamped_distance(const MovingFour& four, double distance, double thickness);

/// How far the points of one side (bits of `side`) are beyond all others along the unit vector `direction`, at a time, m. As
/// points move on straight lines, it is never less between two times than the smaller of the two values, and the distance is
/// never less than it.
double gap_along(const MovingFour& four, unsigned side, const Vec3& direction, double time);

}  // namespace percale
