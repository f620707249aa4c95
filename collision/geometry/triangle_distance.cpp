#include "geometry/triangle_distance.h"

#include <algorithm>

namespace percale {
namespace {

/// |ab x ac|^2 over the longest edge to the fourth. Narrower triangles get their weights from cross products. Smaller: closest
/// points on needles have no correct digit. Larger: slower.
constexpr double sliver_area = 1e-6;

PointTriangle at_vertex(const Vec3& p, const Vec3& x, int corner) {
    PointTriangle result{
        .distance_squared = (p - x).squaredNorm(), .weight = {}, .region = TriangleRegion::vertex, .corner = corner, .point = x};
    result.weight[corner] = 1.0;
    return result;
}

PointTriangle at_edge(const Vec3& p, const Vec3& from, const Vec3& to, double fraction, int corner) {
    const Vec3 x = from + fraction * (to - from);
    PointTriangle result{
        .distance_squared = (p - x).squaredNorm(), .weight = {}, .region = TriangleRegion::edge, .corner = corner, .point = x};
    result.weight[corner] = 1.0 - fraction;
    result.weight[(corner + 1) % 3] = fraction;
    return result;
}

PointTriangle at_face(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const std::array<double, 3>& weight) {
    const double v = weight[1], w = weight[2];
    const Vec3 x = a + v * (b - a) + w * (c - a);
    return {.distance_squared = (p - x).squaredNorm(),
            .weight = {1.0 - v - w, v, w},
            .region = TriangleRegion::face,
            .corner = 0,
            .point = x};
}

PointTriangle on_segment(const Vec3& p, const Vec3& from, const Vec3& to, int corner) {
    const Vec3 along = to - from;
    const double length = along.squaredNorm(), projection = along.dot(p - from);
    if (!(projection > 0.0)) return at_vertex(p, from, corner);
    if (projection >= length) return at_vertex(p, to, (corner + 1) % 3);
    return at_edge(p, from, to, projection / length, corner);
}

/// For triangles so narrow that products of dot products retain no digits of the area: weights come from cross products, which
/// lose half as many digits, and from the edges where these disagree about the inside.
PointTriangle on_sliver(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    PointTriangle best = on_segment(p, a, b, 0);
    for (const PointTriangle& other : {on_segment(p, b, c, 1), on_segment(p, c, a, 2)}) {
        if (other.distance_squared < best.distance_squared) best = other;
    }
    const Vec3 normal = (b - a).cross(c - a);
    const double area = normal.squaredNorm();
    const double v = normal.dot((p - a).cross(c - a)) / area, w = normal.dot((b - a).cross(p - a)) / area;
    if (!(area > 0.0 && v > 0.0 && w > 0.0 && v + w < 1.0)) return best;
    const PointTriangle inside = at_face(p, a, b, c, {1.0 - v - w, v, w});
    return inside.distance_squared < best.distance_squared ? inside : best;
}

}  // namespace

PointTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0.0 && d2 <= 0.0) return at_vertex(p, a, 0);
    const Vec3 bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0.0 && d4 <= d3) return at_vertex(p, b, 1);
    const double vc = d1 * d4 - d3 * d2;
    // An edge without length has d1 = d3; the other two edges then coincide.
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3) return at_edge(p, a, b, d1 / (d1 - d3), 0);
    const Vec3 cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0.0 && d5 <= d6) return at_vertex(p, c, 2);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6) return at_edge(p, c, a, 1.0 - d2 / (d2 - d6), 2);
    const double va = d3 * d6 - d5 * d4;
    const double from_b = d4 - d3, from_c = d5 - d6;
    if (va <= 0.0 && from_b >= 0.0 && from_c >= 0.0 && from_b + from_c > 0.0)
        return at_edge(p, b, c, from_b / (from_b + from_c), 1);
    // The sum is |ab x ac|^2 with the rounding of the longest edge to the fourth.
    const double sum = va + vb + vc, longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()});
    if (!(sum > sliver_area * longest * longest)) return on_sliver(p, a, b, c);
    return at_face(p, a, b, c, {va / sum, vb / sum, vc / sum});
}

EdgeEdge closest_on_edges(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
    const Vec3 u = q - p, v = b - a, r = p - a;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
    // The closest points of the lines come from cross products: uu vv - uv^2 has no digits left for angles below 1e-8. For
    // parallel lines any s is valid, and the clamping below finds the closest t and then s again.
    const Vec3 normal = u.cross(v);
    const double area = normal.squaredNorm();
    double s = area > 0.0 ? std::clamp(normal.dot(v.cross(r)) / area, 0.0, 1.0) : 0.0;
    double t = vv > 0.0 ? (uv * s + vr) / vv : 0.0;
    if (t < 0.0 || t > 1.0 || vv == 0.0) {
        t = std::clamp(t, 0.0, 1.0);
        s = uu > 0.0 ? std::clamp((uv * t - ur) / uu, 0.0, 1.0) : 0.0;
    }
    return {.distance_squared = (r + s * u - t * v).squaredNorm(), .s = s, .t = t};
}

}  // namespace percale
