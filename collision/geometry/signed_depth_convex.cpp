#include "geometry/signed_depth_convex.h"

#include <ccd/ccd.h>

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

/// Fraction of the larger extent of two hulls. libccd's expanding polytope ends there. At libccd's own tolerance, 1e-4 m, depths
/// are wrong by up to 24 mm.
constexpr double hull_depth = 1e-9;

/// Maximum number of libccd's iterations. Without a limit the expanding polytope may not end.
constexpr unsigned long max_hull_iterations = 1000;

static_assert(sizeof(ccd_real_t) == sizeof(double), "libccd has to be its double-precision build");

using Points = std::span<const Vec3>;

const Vec3& farthest(Points points, const Vec3& direction) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vec3& a, const Vec3& b) { return a.dot(direction) < b.dot(direction); });
}

void support(const void* points, const ccd_vec3_t* direction, ccd_vec3_t* result) {
    const Vec3& x = farthest(*static_cast<const Points*>(points), {direction->v[0], direction->v[1], direction->v[2]});
    ccdVec3Set(result, x.x(), x.y(), x.z());
}

/// The largest distance of a point from the first one, m.
double extent(Points points) {
    double square = 0.0;
    for (const Vec3& x : points) square = std::max(square, (x - points[0]).squaredNorm());
    return std::sqrt(square);
}

/// How far the first set has to go along the direction to be beyond the second.
double exit_distance(Points first, Points second, const Vec3& direction) {
    return farthest(second, direction).dot(direction) - farthest(first, -direction).dot(direction);
}

}  // namespace

std::optional<HullOverlap> hull_overlap(Points first, Points second) {
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    // At the library's own tolerance depths are wrong by centimetres, and without a limit it may not end.
    ccd.epa_tolerance = hull_depth * std::max(extent(first), extent(second));
    ccd.max_iterations = max_hull_iterations;
    ccd_real_t depth = 0.0;
    ccd_vec3_t axis, place;
    if (ccdGJKPenetration(&first, &second, &ccd, &depth, &axis, &place) != 0) return std::nullopt;
    Vec3 direction(axis.v[0], axis.v[1], axis.v[2]);
    if (!(direction.norm() > 0.0)) return std::nullopt;
    direction.normalize();
    // The supports along the direction give a sufficient depth, whatever the polytope's error.
    const double ahead = exit_distance(first, second, direction), back = exit_distance(first, second, -direction);
    if (ahead <= back) return HullOverlap{.depth = ahead, .direction = direction};
    return HullOverlap{.depth = back, .direction = -direction};
}

}  // namespace percale
