#include "untangle/untangle_obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "certificate/inside_test.h"
#include "certificate/triangle_gap.h"
#include "geometry/triangle_distance.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Barycentric. A ray meets a triangle up to this far beyond its rim, so that it does not slip through an edge between two of
/// them.
constexpr double ray_rim = 1e-9;

/// Fraction of the obstacle's diagonal. Distance beyond an intersection at which it is tested whether a ray is outside. See
/// beyond_face.
constexpr double beyond_exit = 1e-9;

/// Fraction of the triangle's size. A vertex nearer to its triangle leaves along the normal, because its own direction is
/// rounding.
constexpr double on_triangle = 1e-9;

using certificate::Corners;

/// Whether the ray from `point` along `direction` meets the box (slab test).
bool meets(const certificate::Box& box, const Vec3& point, const Vec3& direction) {
    double first = 0.0, last = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) {
            if (point[axis] < box.low[axis] || point[axis] > box.high[axis]) return false;
            continue;
        }
        const double a = (box.low[axis] - point[axis]) / direction[axis], b = (box.high[axis] - point[axis]) / direction[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

/// Where the ray meets the triangle (Moeller and Trumbore 1997), its rim included; nothing where it misses or runs along it.
std::optional<double> meeting(const Corners& t, const Vec3& point, const Vec3& direction) {
    constexpr double rim = ray_rim;
    const Vec3 u = t[1] - t[0], v = t[2] - t[0], p = direction.cross(v);
    const double determinant = u.dot(p);
    if (determinant == 0.0) return std::nullopt;
    const Vec3 from = point - t[0], q = from.cross(u);
    const double a = from.dot(p) / determinant, b = direction.dot(q) / determinant, distance = v.dot(q) / determinant;
    if (a < -rim || b < -rim || a + b > 1.0 + rim || !(distance > 0.0)) return std::nullopt;
    return distance;
}

Vec3 normal_of(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }

}  // namespace

SolidObstacle::SolidObstacle(TriangleMesh mesh)
    : mesh_(std::move(mesh)),
      triangles_(certificate::corners_of(mesh_)),
      tree_(triangles_),
      watertight_(certificate::is_watertight(mesh_)) {}

bool SolidObstacle::inside(const Vec3& point) const {
    return watertight_ && tree_.bounds().contains(point) &&
           certificate::side_of(point, triangles_, tree_) == certificate::Side::inside;
}

std::optional<double> SolidObstacle::exit(const Vec3& point, const Vec3& direction) const {
    std::vector<double> places;
    tree_.walk([&](const certificate::Box& box) { return meets(box, point, direction); },
               [&](int item) {
                   if (const auto place = meeting(triangles_[item], point, direction)) places.push_back(*place);
               });
    std::sort(places.begin(), places.end());
    const double little = beyond_exit * (tree_.bounds().high - tree_.bounds().low).norm();
    const auto leaves = [&](double place) { return !inside(point + (place + little) * direction); };
    const auto first = std::find_if(places.begin(), places.end(), leaves);
    return first == places.end() ? std::nullopt : std::optional(*first);
}

Vec3 SolidObstacle::pushed_out(const Vec3& point, double clearance) const {
    certificate::Box here;
    here.add(point);
    const auto box_distance = [&](const certificate::Box& box) {
        return certificate::distance(here, box) * (1.0 - tolerances::bound_slack);
    };
    const auto item_distance = [&](int i) { return certificate::point_triangle_distance(point, triangles_[i]); };
    const auto [nearest, distance] = tree_.nearest(std::numeric_limits<double>::infinity(), box_distance, item_distance);
    const bool within = inside(point);
    if (!within && distance >= clearance) return point;
    const Corners& t = triangles_[nearest];
    const Vec3 foot = closest_on_triangle(point, t[0], t[1], t[2]).point;
    const double size = (t[1] - t[0]).norm() + (t[2] - t[0]).norm();
    const Vec3 out = distance > on_triangle * size ? Vec3((within ? foot - point : point - foot).normalized()) : normal_of(t);
    return foot + clearance * out;
}

}  // namespace percale
