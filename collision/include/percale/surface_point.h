#pragma once

#include <array>
#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// A point that goes along with a surface, on it or beside it: its foot on a triangle, and its offset in that triangle's axes.
struct SurfacePoint {
    Triangle triangle{};              // vertices of the surface
    std::array<double, 3> weights{};  // of these at the foot, each 0 ... 1, sum 1
    Vec3 offset = Vec3::Zero();       // m, from the foot, along the first edge, across it in the plane, and along the normal
};

/// Attaches points to the nearest triangle of a surface, to any one of equally near triangles. Triangles without area are left
/// out. Throws SceneError where the surface has none, or a point is NaN or infinite. Any thread.
std::vector<SurfacePoint> attach(const TriangleMesh& surface, std::span<const Vec3> points);

/// Position of the point for these vertices of the surface, m:  x = sum w_i x_i + o_1 e + o_2 (n x e) + o_3 n,  e along the first
/// edge, n the triangle's normal. Throws SceneError where the triangle has lost its area. Any thread.
Vec3 place_of(const SurfacePoint& point, std::span<const Vec3> vertices);

}  // namespace percale
