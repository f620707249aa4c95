#include "certificate/triangle_overlap.h"

#include <algorithm>

#include "certificate/exact_orientation.h"

namespace percale::certificate {
namespace {

using Signs = std::array<int, 3>;

bool has(const Signs& signs, int sign) { return std::find(signs.begin(), signs.end(), sign) != signs.end(); }
bool straddles(const Signs& signs) { return has(signs, 1) && has(signs, -1); }
bool all(const Signs& signs, int sign) { return signs == Signs{sign, sign, sign}; }
bool misses(const Signs& signs) { return all(signs, 1) || all(signs, -1); }

Signs sides(const Corners& corners, const Corners& plane) {
    Signs signs;
    for (int i = 0; i < 3; ++i) signs[i] = orient3d(plane[0], plane[1], plane[2], corners[i]);
    return signs;
}

int projection_axis(const Corners& t) { return certificate::projection_axis(t[0], t[1], t[2]); }

/// For segments on one common line, or points: their order along the line is the lexicographic order of coordinates.
bool collinear_segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    const auto [low_a, high_a] = std::minmax(p, q, lexicographically_less);
    const auto [low_b, high_b] = std::minmax(r, s, lexicographically_less);
    return !lexicographically_less(high_a, low_b) && !lexicographically_less(high_b, low_a);
}

/// For segments in a plane that projects injectively along `axis`, not all four points on one line.
bool planar_segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, int axis) {
    return orient2d(p, q, r, axis) * orient2d(p, q, s, axis) <= 0 && orient2d(r, s, p, axis) * orient2d(r, s, q, axis) <= 0;
}

bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    if (orient3d(p, q, r, s) != 0) return false;
    const int axis = std::max({certificate::projection_axis(p, q, r), certificate::projection_axis(p, q, s),
                               certificate::projection_axis(r, s, p), certificate::projection_axis(r, s, q)});
    return axis < 0 ? collinear_segments_meet(p, q, r, s) : planar_segments_meet(p, q, r, s, axis);
}

bool segment_meets_edges(const Vec3& p, const Vec3& q, const Corners& t) {
    return segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) || segments_meet(p, q, t[2], t[0]);
}

/// For a point in the plane of a triangle with area.
bool planar_point_inside(const Vec3& p, const Corners& t, int axis) {
    const int turn = orient2d(t[0], t[1], t[2], axis);
    return orient2d(t[0], t[1], p, axis) * turn >= 0 && orient2d(t[1], t[2], p, axis) * turn >= 0 &&
           orient2d(t[2], t[0], p, axis) * turn >= 0;
}

bool segment_meets(const Vec3& p, const Vec3& q, const Corners& t) {
    const int axis = projection_axis(t);
    if (axis < 0) return segment_meets_edges(p, q, t);
    const int side_p = orient3d(t[0], t[1], t[2], p), side_q = orient3d(t[0], t[1], t[2], q);
    if (side_p * side_q > 0) return false;
    if (side_p == 0 && side_q == 0) return planar_point_inside(p, t, axis) || segment_meets_edges(p, q, t);
    // The line meets the plane in one point, which the segment holds; it lies in the triangle where the line passes no two
    // edges in opposite senses.
    const Signs turns = {orient3d(p, q, t[0], t[1]), orient3d(p, q, t[1], t[2]), orient3d(p, q, t[2], t[0])};
    return !straddles(turns);
}

bool share_points(const Corners& a, const Corners& b) {
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (segment_meets(a[i], a[j], b) || segment_meets(b[i], b[j], a)) return true;
    }
    return false;
}

Overlap touching_or_disjoint(const Corners& a, const Corners& b) {
    return share_points(a, b) ? Overlap::touching : Overlap::disjoint;
}

/// The corner that is alone on its open side of the other's plane; the other two lie on the closed other side.
int lone_corner(const Signs& signs) {
    const int sign = std::count(signs.begin(), signs.end(), 1) == 1 ? 1 : -1;
    return static_cast<int>(std::find(signs.begin(), signs.end(), sign) - signs.begin());
}

/// Each triangle straddles the other's plane. The two edges at the lone corner of each cut the common line L of the planes in the
/// two ends of its segment on L. The volume spanned by an edge of a and one of b is the signed distance of their intersections
/// with L times a factor whose sign is the same for all four pairs, so the segments overlap where two volumes differ in sign.
Overlap classify_transversal(const Corners& a, const Signs& side_a, const Corners& b, const Signs& side_b) {
    const int i = lone_corner(side_a), j = lone_corner(side_b);
    bool above = false, below = false, zero = false;
    for (int k = 0; k < 4; ++k) {
        const int order = orient3d(a[i], a[(i + 1 + k / 2) % 3], b[j], b[(j + 1 + k % 2) % 3]);
        above |= order > 0;
        below |= order < 0;
        zero |= order == 0;
    }
    if (above && below) return Overlap::crossing;
    return zero ? Overlap::touching : Overlap::disjoint;
}

/// Whether all of b lies on the closed outer side of an edge of a (both in one plane).
bool edge_separates(const Corners& a, const Corners& b, int axis) {
    const int turn = orient2d(a[0], a[1], a[2], axis);
    for (int i = 0; i < 3; ++i) {
        const auto outside = [&](const Vec3& p) { return orient2d(a[i], a[(i + 1) % 3], p, axis) * turn <= 0; };
        if (std::all_of(b.begin(), b.end(), outside)) return true;
    }
    return false;
}

Overlap classify_planar(const Corners& a, const Corners& b) {
    const int axis = projection_axis(a);
    const bool has_area = axis >= 0 && projection_axis(b) >= 0;
    if (has_area && !edge_separates(a, b, axis) && !edge_separates(b, a, axis)) return Overlap::crossing;
    return touching_or_disjoint(a, b);
}

}  // namespace

Overlap classify(const Corners& a, const Corners& b) {
    const Signs side_a = sides(a, b);
    if (misses(side_a)) return Overlap::disjoint;
    const Signs side_b = sides(b, a);
    if (misses(side_b)) return Overlap::disjoint;
    if (straddles(side_a) && straddles(side_b)) return classify_transversal(a, side_a, b, side_b);
    if (all(side_a, 0) && all(side_b, 0)) return classify_planar(a, b);
    return touching_or_disjoint(a, b);
}

bool lies_on(const Vec3& point, const Corners& t) {
    const int axis = projection_axis(t);
    if (axis < 0) return segment_meets_edges(point, point, t);
    return orient3d(t[0], t[1], t[2], point) == 0 && planar_point_inside(point, t, axis);
}

}  // namespace percale::certificate
