#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "percale/mesh.h"

// Distances in long double by trying every case, without the code under test.
namespace percale::test {

using LongVec = Eigen::Matrix<long double, 3, 1>;

inline long double point_segment(const LongVec& p, const LongVec& a, const LongVec& b) {
    const LongVec u = b - a;
    const long double length = u.squaredNorm();
    const long double t = length > 0.0L ? std::clamp<long double>(u.dot(p - a) / length, 0.0L, 1.0L) : 0.0L;
    return (p - a - t * u).norm();
}

inline double true_point_triangle(const Vec3& point, const Vec3& x, const Vec3& y, const Vec3& z) {
    const LongVec p = point.cast<long double>();
    const std::array<LongVec, 3> corner{x.cast<long double>(), y.cast<long double>(), z.cast<long double>()};
    const LongVec normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    long double least = std::numeric_limits<long double>::infinity();
    bool above = normal.squaredNorm() > 0.0L;
    for (int k = 0; k < 3; ++k) {
        const LongVec &a = corner[k], &b = corner[(k + 1) % 3];
        least = std::min(least, point_segment(p, a, b));
        above = above && (b - a).cross(p - a).dot(normal) >= 0.0L;
    }
    if (above) least = std::min(least, std::abs(normal.dot(p - corner[0])) / normal.norm());
    return static_cast<double>(least);
}

inline double true_edge_edge(const Vec3& p_, const Vec3& q_, const Vec3& a_, const Vec3& b_) {
    const LongVec p = p_.cast<long double>(), q = q_.cast<long double>(), a = a_.cast<long double>(), b = b_.cast<long double>();
    long double least =
        std::min({point_segment(p, a, b), point_segment(q, a, b), point_segment(a, p, q), point_segment(b, p, q)});
    const LongVec u = q - p, v = b - a, r = a - p, normal = u.cross(v);
    const long double area = normal.squaredNorm();
    if (area > 0.0L) {
        const long double s = r.cross(v).dot(normal) / area, t = r.cross(u).dot(normal) / area;
        if (s >= 0.0L && s <= 1.0L && t >= 0.0L && t <= 1.0L) least = std::min(least, (r + t * v - s * u).norm());
    }
    return static_cast<double>(least);
}

/// Smallest distance of two triangles that do not cross.
inline double true_triangle_triangle(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        least = std::min({least, true_point_triangle(a[i], b[0], b[1], b[2]), true_point_triangle(b[i], a[0], a[1], a[2])});
        for (int k = 0; k < 3; ++k) least = std::min(least, true_edge_edge(a[i], a[(i + 1) % 3], b[k], b[(k + 1) % 3]));
    }
    return least;
}

inline std::array<Vec3, 3> corners_of(const TriangleMesh& mesh, const Triangle& t) {
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// Smallest distance of two meshes that do not cross.
inline double true_mesh_distance(const TriangleMesh& cloth, const TriangleMesh& obstacle) {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : cloth.triangles) {
        for (const Triangle& o : obstacle.triangles) {
            least = std::min(least, true_triangle_triangle(corners_of(cloth, t), corners_of(obstacle, o)));
        }
    }
    return least;
}

}  // namespace percale::test
