#include "percale/signed_depth.h"

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

/// Signed distance to an axis-parallel box in any dimension, from what a point is beyond each of its faces.
template <class Vector>
double beyond_distance(const Vector& beyond) {
    return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

}  // namespace

double plane_distance(const Vec3& point) { return point.y(); }

double sphere_distance(const Vec3& point, double radius) { return point.norm() - radius; }

double box_distance(const Vec3& point, const Vec3& size) { return beyond_distance(Vec3(point.cwiseAbs() - 0.5 * size)); }

double cylinder_distance(const Vec3& point, double radius, double height) {
    return beyond_distance(Eigen::Vector2d(std::hypot(point.x(), point.z()) - radius, std::abs(point.y()) - 0.5 * height));
}

double capsule_distance(const Vec3& point, double radius, double height) {
    const double along = std::clamp(point.y(), -0.5 * height, 0.5 * height);
    return (point - Vec3(0.0, along, 0.0)).norm() - radius;
}

}  // namespace percale
