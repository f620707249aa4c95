#pragma once

#include <algorithm>
#include <array>

#include "percale/mesh.h"

namespace percale::certificate {

using Corners = std::array<Vec3, 3>;  // m

/// Compares by x, then y, then z.
inline bool lexicographically_less(const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

enum class Overlap { disjoint, touching, crossing };

/// How two closed triangles lie to each other, decided exactly (range: exact_orientation.h).
/// crossing: each has corners strictly on both sides of the other's plane and they share a segment of positive length; or they
///           are coplanar and share an area.
/// touching: they share a point but do not cross: a corner or edge that rests on the other without passing it, or edges (or an
///           edge and a corner) that pass each other in a single point.
/// Where two surfaces pass through each other, their common curve leaves such a single point in a neighbouring pair that
/// crosses; only a curve that runs exactly along edges for its whole length shows as touching pairs alone.
/// A triangle without area has no plane to cross: it never crosses, it touches where it shares a point.
/// Independent of the order of the arguments and of the corners.
Overlap classify(const Corners& a, const Corners& b);

/// Whether the point lies on the closed triangle, exactly; triangles without area are segments or points.
bool lies_on(const Vec3& point, const Corners& triangle);

}  // namespace percale::certificate
