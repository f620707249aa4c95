#include <algorithm>
#include <cmath>

#include "percale/mesh.h"

namespace percale {
namespace {

/// Radians. Below it the chord between two turns differs from the arc by less than rounding, and sines would divide 0 by 0.
constexpr double min_arc = 1e-5;

double dot(const Rotation& p, const Rotation& q) { return p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z; }

Rotation sum(double s, const Rotation& a, double t, const Rotation& b) {
    const Rotation r = {s * a.w + t * b.w, s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
    const double length = std::sqrt(dot(r, r));
    return {r.w / length, r.x / length, r.y / length, r.z / length};
}

// (sin((1-f) a) p + sin(f a) q) / sin a with the angle a between p and q; of q and -q, the same rotation, the nearer is taken.
Rotation between(const Rotation& p, const Rotation& q, double f) {
    const double cosine = dot(p, q);
    const double side = cosine < 0.0 ? -1.0 : 1.0;
    const double angle = std::acos(std::min(1.0, std::abs(cosine)));
    if (angle < min_arc) return sum(1.0 - f, p, side * f, q);
    return sum(std::sin((1.0 - f) * angle), p, side * std::sin(f * angle), q);
}

}  // namespace

bool operator==(const Pose& a, const Pose& b) {
    const Rotation &p = a.rotation, &q = b.rotation;
    return a.translation == b.translation && p.w == q.w && p.x == q.x && p.y == q.y && p.z == q.z && a.scale == b.scale;
}

Vec3 transform(const Pose& pose, const Vec3& point) {
    const Vec3 axis(pose.rotation.x, pose.rotation.y, pose.rotation.z);
    const Vec3 scaled = pose.scale * point;
    // q p q* without forming a matrix: p + 2 w (u x p) + 2 u x (u x p)
    const Vec3 turn = 2.0 * axis.cross(scaled);
    return pose.translation + scaled + pose.rotation.w * turn + axis.cross(turn);
}

Vec3 inverse_transform(const Pose& pose, const Vec3& x) {
    const Rotation& q = pose.rotation;
    const Pose back{.translation = Vec3::Zero(), .rotation = {q.w, -q.x, -q.y, -q.z}, .scale = 1.0 / pose.scale};
    return transform(back, x - pose.translation);
}

std::vector<Vec3> transform(const Pose& pose, std::span<const Vec3> points) {
    std::vector<Vec3> image;
    image.reserve(points.size());
    for (const Vec3& point : points) image.push_back(transform(pose, point));
    return image;
}

Rotation product(const Rotation& a, const Rotation& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

double angle_between(const Rotation& a, const Rotation& b) { return 2.0 * std::acos(std::min(1.0, std::abs(dot(a, b)))); }

Pose interpolate(const Pose& from, const Pose& to, double fraction) {
    Pose pose = from;
    pose.translation += fraction * (to.translation - from.translation);
    pose.rotation = between(from.rotation, to.rotation, fraction);
    return pose;
}

}  // namespace percale
