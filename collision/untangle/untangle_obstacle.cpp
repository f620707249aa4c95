#include "untangle/untangle_obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "certificate/inside_test.h"
#include "certificate/triangle_gap.h"
#include "geometry/triangle_distance.h"

namespace percale {
namespace {

using certificate::Box;
using certificate::Corners;

/// Whether the ray from `point` along `way` meets the box (slab test).
bool meets(const Box& box, const Vec3& point, const Vec3& way) {
    double first = 0.0, last = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (way[axis] == 0.0) {
            if (point[axis] < box.low[axis] || point[axis] > box.high[axis]) return false;
            continue;
        }
        const double a = (box.low[axis] - point[axis]) / way[axis], b = (box.high[axis] - point[axis]) / way[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

/// Where the ray meets the triangle (Moeller and Trumbore 1997), its rim included; nothing where it misses or runs along it.
std::optional<double> meeting(const Corners& t, const Vec3& point, const Vec3& way) {
    constexpr double rim = 1e-9;
    const Vec3 u = t[1] - t[0], v = t[2] - t[0], p = way.cross(v);
    const double determinant = u.dot(p);
    if (determinant == 0.0) return std::nullopt;
    const Vec3 from = point - t[0], q = from.cross(u);
    const double a = from.dot(p) / determinant, b = way.dot(q) / determinant, distance = v.dot(q) / determinant;
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

std::optional<double> SolidObstacle::exit(const Vec3& point, const Vec3& way) const {
    std::vector<double> places;
    tree_.walk([&](const Box& box) { return meets(box, point, way); },
               [&](int item) {
                   if (const auto place = meeting(triangles_[item], point, way)) places.push_back(*place);
               });
    std::sort(places.begin(), places.end());
    const double little = 1e-9 * (tree_.bounds().high - tree_.bounds().low).norm();
    const auto leaves = [&](double place) { return !inside(point + (place + little) * way); };
    const auto first = std::find_if(places.begin(), places.end(), leaves);
    return first == places.end() ? std::nullopt : std::optional(*first);
}

Vec3 SolidObstacle::pushed_out(const Vec3& point, double clearance) const {
    Box here;
    here.add(point);
    const auto box_distance = [&](const Box& box) { return certificate::distance(here, box) * (1.0 - 1e-9); };
    const auto item_distance = [&](int i) { return certificate::point_triangle_distance(point, triangles_[i]); };
    const auto [nearest, distance] = tree_.nearest(std::numeric_limits<double>::infinity(), box_distance, item_distance);
    const bool within = inside(point);
    if (!within && distance >= clearance) return point;
    const Corners& t = triangles_[nearest];
    const Vec3 foot = closest_on_triangle(point, t[0], t[1], t[2]).point;
    const double size = (t[1] - t[0]).norm() + (t[2] - t[0]).norm();
    const Vec3 out = distance > 1e-9 * size ? Vec3((within ? foot - point : point - foot).normalized()) : normal_of(t);
    return foot + clearance * out;
}

}  // namespace percale
