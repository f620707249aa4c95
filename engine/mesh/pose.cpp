#include "percale/mesh.h"

namespace percale {

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

std::vector<Vec3> transform(const Pose& pose, std::span<const Vec3> points) {
    std::vector<Vec3> image;
    image.reserve(points.size());
    for (const Vec3& point : points) image.push_back(transform(pose, point));
    return image;
}

}  // namespace percale
