#include "certificate/triangle_gap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace percale::certificate {
namespace {

Corners sorted(Corners t) {
    std::sort(t.begin(), t.end(), lexicographically_less);
    return t;
}

/// Parameter in [0, 1] of the point of the segment a + s edge nearest to `point`; 0 for a segment without length.
double nearest_parameter(const Vec3& point, const Vec3& a, const Vec3& edge) {
    const double length2 = edge.squaredNorm();
    return length2 > 0.0 ? std::clamp((point - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
}

/// Distance from the foot of the perpendicular on the triangle's plane if it falls inside, else infinity. The foot is formed from
/// positive weights that sum to 1, so it is a point of the triangle however badly shaped.
double foot_distance(const Vec3& point, const Corners& t) {
    const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = point - t[0];
    const Vec3 normal = ab.cross(ac);
    const double area2 = normal.squaredNorm();
    const double beta = ap.cross(ac).dot(normal), gamma = ab.cross(ap).dot(normal);
    if (!(area2 > 0.0) || beta < 0.0 || gamma < 0.0 || beta + gamma > area2) return std::numeric_limits<double>::infinity();
    return (ap - (beta / area2) * ab - (gamma / area2) * ac).norm();
}

/// Distance at the common perpendicular of two segments, at parameters clamped to both; parallel segments are covered by their
/// end points.
double edge_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a, v = d - c, w = a - c;
    const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
    const double determinant = u.cross(v).squaredNorm();  // = uu vv - uv^2 without its cancellation
    if (!(determinant > 0.0)) return std::numeric_limits<double>::infinity();
    const double start = std::clamp((uv * v.dot(w) - vv * u.dot(w)) / determinant, 0.0, 1.0);
    const double t = nearest_parameter(a + start * u, c, v);
    const double s = uu > 0.0 ? nearest_parameter(c + t * v, a, u) : 0.0;
    return (w + s * u - t * v).norm();
}

/// Gap between a slab that starts from `origin` and a triangle; negative where they overlap.
double slab_gap(const Vec3& origin, const Slab& slab, const Corners& t) {
    const double first = slab.normal.dot(t[0] - origin), second = slab.normal.dot(t[1] - origin),
                 third = slab.normal.dot(t[2] - origin);
    return std::max(std::min({first, second, third}) - slab.high, slab.low - std::max({first, second, third}));
}

Slab slab_along(const Vec3& direction, const Corners& t) {
    const double length = direction.norm();
    if (!(length > 0.0)) return {};
    const Vec3 normal = direction / length;
    const double second = normal.dot(t[1] - t[0]), third = normal.dot(t[2] - t[0]);
    return {normal, std::min({0.0, second, third}), std::max({0.0, second, third})};
}

}  // namespace

double point_segment_distance(const Vec3& point, const Vec3& a, const Vec3& b) {
    const Vec3 edge = b - a;
    const double at_foot = (point - a - nearest_parameter(point, a, edge) * edge).norm();
    return std::min({at_foot, (point - a).norm(), (point - b).norm()});
}

double point_triangle_distance(const Vec3& point, const Corners& t) {
    return std::min({foot_distance(point, t), point_segment_distance(point, t[0], t[1]),
                     point_segment_distance(point, t[1], t[2]), point_segment_distance(point, t[2], t[0])});
}

double triangle_distance(const Corners& a_given, const Corners& b_given) {
    Corners a = sorted(a_given), b = sorted(b_given);
    if (std::lexicographical_compare(b.begin(), b.end(), a.begin(), a.end(), lexicographically_less)) std::swap(a, b);
    double smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        smallest = std::min({smallest, point_triangle_distance(a[i], b), point_triangle_distance(b[i], a)});
        for (int j = 0; j < 3; ++j) smallest = std::min(smallest, edge_distance(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    }
    return smallest;
}

Slab slab_of(const Corners& t) { return slab_along((t[1] - t[0]).cross(t[2] - t[0]), t); }

double triangle_separation(const Corners& a, const Slab& slab, const Corners& b, double enough) {
    const double along_a = slab_gap(a[0], slab, b);
    if (along_a > enough) return along_a;
    const double along_b = slab_gap(b[0], slab_of(b), a);
    if (along_b > enough) return along_b;
    const Vec3 between = (b[0] + b[1] + b[2]) - (a[0] + a[1] + a[2]);
    return std::max({0.0, along_a, along_b, slab_gap(a[0], slab_along(between, a), b)});
}

}  // namespace percale::certificate
