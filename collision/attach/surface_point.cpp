#include "percale/surface_point.h"

#include <cmath>
#include <limits>
#include <optional>

#include "certificate/box_tree.h"
#include "certificate/triangle_gap.h"
#include "geometry/triangle_distance.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale {
namespace {

using certificate::Corners;

/// Twice the area over the product of two edges: the sine between them. Points are not attached to flatter triangles, which have
/// no normal.
constexpr double flat_triangle = 1e-9;

/// Columns: along the first edge, across it in the plane, along the normal. Returns nothing for a triangle without area.
std::optional<Eigen::Matrix3d> axes_of(const Corners& t) {
    const Vec3 along = t[1] - t[0], normal = along.cross(t[2] - t[0]);
    if (!(normal.norm() > flat_triangle * along.norm() * (t[2] - t[0]).norm())) return std::nullopt;
    Eigen::Matrix3d axes;
    axes.col(0) = along.normalized();
    axes.col(2) = normal.normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
}

Corners corners_at(const Triangle& t, std::span<const Vec3> x) { return {x[t[0]], x[t[1]], x[t[2]]}; }

}  // namespace

std::vector<SurfacePoint> attach(const TriangleMesh& surface, std::span<const Vec3> points) {
    std::vector<Triangle> triangles;
    std::vector<Corners> places;
    for (const Triangle& t : surface.triangles) {
        const Corners place = corners_at(t, surface.vertices);
        if (!axes_of(place)) continue;
        triangles.push_back(t);
        places.push_back(place);
    }
    if (triangles.empty()) throw SceneError("attach: the surface has no triangle with an area");
    const certificate::BoxTree tree{std::span<const Corners>(places)};
    std::vector<SurfacePoint> attached;
    for (const Vec3& point : points) {
        if (!point.allFinite()) throw SceneError("attach: point " + std::to_string(attached.size()) + " is not finite");
        certificate::Box here;
        here.add(point);
        const auto [nearest, distance] = tree.nearest(
            std::numeric_limits<double>::infinity(),
            [&](const certificate::Box& box) { return certificate::distance(here, box) * (1.0 - tolerances::bound_slack); },
            [&](int i) { return certificate::point_triangle_distance(point, places[i]); });
        const Corners& t = places[nearest];
        const PointTriangle foot = closest_on_triangle(point, t[0], t[1], t[2]);
        attached.push_back({triangles[nearest], foot.weight, axes_of(t)->transpose() * (point - foot.point)});
    }
    return attached;
}

Vec3 place_of(const SurfacePoint& point, std::span<const Vec3> vertices) {
    const Corners t = corners_at(point.triangle, vertices);
    const std::optional<Eigen::Matrix3d> axes = axes_of(t);
    if (!axes) {
        throw SceneError("triangle " + std::to_string(point.triangle[0]) + ", " + std::to_string(point.triangle[1]) + ", " +
                         std::to_string(point.triangle[2]) + " of a surface has lost its area, on which a point is attached");
    }
    return point.weights[0] * t[0] + point.weights[1] * t[1] + point.weights[2] * t[2] + *axes * point.offset;
}

}  // namespace percale
