#pragma once

#include "certificate/triangle_overlap.h"
#include "percale/mesh.h"

namespace percale::certificate {

// Distances in double precision for triangles of any shape, those without area included: every result is the length between a
// point of each, so apart from rounding never less than the true distance. Error some 1e-15 of the largest coordinate; where two
// edges pass each other at a small angle, 1e-15 of their length divided by that angle, at most 1e-7 of their length.

/// Distance of a point from the segment ab, m.
double point_segment_distance(const Vec3& point, const Vec3& a, const Vec3& b);

/// Distance of a point from the closed triangle, m.
double point_triangle_distance(const Vec3& point, const Corners& triangle);

/// Smallest distance between two triangles that share no point, m: over corners against triangles and edges against edges.
/// Bitwise independent of the order of the arguments and of the corners.
double triangle_distance(const Corners& a, const Corners& b);

/// A triangle between two parallel planes, as narrow as rounding allows.
struct Slab {
    Vec3 normal = Vec3::Zero();    // unit; 0 for a triangle without area, which then separates from nothing
    double low = 0.0, high = 0.0;  // m, range of normal . (corner - first corner)
};

Slab slab_of(const Corners& triangle);

/// A cheap lower bound of the distance of two triangles, m, good where they face each other: their separation along the normal of
/// a (its slab given), and where that is not above `enough`, also along the normal of b and the line of their centres.
double triangle_separation(const Corners& a, const Slab& slab, const Corners& b, double enough);

}  // namespace percale::certificate
