#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/cloth_surface.h"
#include "percale/certify.h"

namespace percale {

/// An edge of cloth that pierces a triangle of cloth: a point of the curve in which cloth crosses cloth.
struct EdgeCrossing {
    std::array<int, 2> edge = {-1, -1};
    Triangle triangle = {-1, -1, -1};
    double share = 0.0;                              // of the edge, from its first vertex to the point
    std::array<double, 3> weight = {0.0, 0.0, 0.0};  // of the triangle's corners at the point
    /// Direction in which the edge has to move relative to the triangle to shorten the curve fastest; without unit, of length at
    /// most 2 except where the edge lies nearly in the triangle's plane.
    Vec3 retreat = Vec3::Zero();
};

/// Finds all of them between the triangles of the pairs. An edge does not pierce a triangle that it shares a vertex with.
///
/// With E along the edge, N the triangle's normal, R_k in the triangle's plane along the curve into each face at the edge, and S
/// the sum of all R_k, the retreat vector is S - 2 (E . S)/(E . N) N (Volino and Magnenat-Thalmann, Resolving surface collisions
/// through intersection contour minimization, 2006). A move u of one of two surfaces against the other changes the length of the
/// curve in which they cross by -1/2 u . (the sum of the retreat vectors of its edges, less that of the edges that pierce it).
std::vector<EdgeCrossing> edge_crossings(const ClothSurface& surface, std::span<const IntersectingPair> pairs,
                                         std::span<const Vec3> positions);

}  // namespace percale
