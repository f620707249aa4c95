#pragma once

#include <array>

#include "percale/mesh.h"

namespace percale {

/// Where on a triangle a closest point lies.
enum class TriangleRegion { face, vertex, edge };

struct PointTriangle {
    double distance_squared = 0.0;   // m^2
    std::array<double, 3> weight{};  // barycentric, sums to 1
    TriangleRegion region = TriangleRegion::face;
    int corner = 0;             // which vertex, or the first vertex of which edge (corner, corner + 1)
    Vec3 point = Vec3::Zero();  // on the triangle
};

/// Closest point of triangle abc to p, by Voronoi regions (Ericson, Real-Time Collision Detection, 5.1.5).
PointTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

struct EdgeEdge {
    double distance_squared = 0.0;  // m^2
    double s = 0.0, t = 0.0;        // 0 ... 1 along the first and the second segment
};

/// Closest points of segments pq and ab, parallel and point-like ones included (Ericson 5.1.9).
EdgeEdge closest_on_edges(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b);

}  // namespace percale
