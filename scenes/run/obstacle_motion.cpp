#include "run/obstacle_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tolerances.h"

namespace percale::scenes {
namespace {

Rotation product(const Rotation& a, const Rotation& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Rotation sum(double s, const Rotation& a, double t, const Rotation& b) {
    const Rotation r = {s * a.w + t * b.w, s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
    const double length = std::sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z);
    return {r.w / length, r.x / length, r.y / length, r.z / length};
}

// (sin((1-f) a) p + sin(f a) q) / sin a with the angle a between p and q; of q and -q, the same turn, the nearer is taken.
Rotation between(const Rotation& p, const Rotation& q, double f) {
    const double dot = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z;
    const double side = dot < 0.0 ? -1.0 : 1.0;
    const double angle = std::acos(std::min(1.0, std::abs(dot)));
    if (angle < least_arc) return sum(1.0 - f, p, side * f, q);
    return sum(std::sin((1.0 - f) * angle), p, side * std::sin(f * angle), q);
}

Pose keyframe_pose(const ObstacleSpec& obstacle, double time) {
    Pose before = obstacle.pose;
    double time_before = 0.0;
    for (std::size_t i = 0; i < obstacle.motion.size(); ++i) {
        const Keyframe& frame = obstacle.motion[i];
        Pose after = before;
        after.translation = frame.translation.value_or(before.translation);
        after.rotation = frame.rotation.value_or(before.rotation);
        if (time <= frame.time) {
            if (i == 0 || time == frame.time) return after;
            const double f = (time - time_before) / (frame.time - time_before);
            before.translation += f * (after.translation - before.translation);
            before.rotation = between(before.rotation, after.rotation, f);
            return before;
        }
        before = after;
        time_before = frame.time;
    }
    return before;
}

}  // namespace

Pose obstacle_pose_at(const ObstacleSpec& obstacle, double time) {
    Pose pose = keyframe_pose(obstacle, time);
    if (!obstacle.spin || time <= obstacle.spin->from) return pose;
    const Spin& spin = *obstacle.spin;
    const double half = std::numbers::pi * spin.turns_per_s * (time - spin.from);
    const Vec3 axis = std::sin(half) * spin.axis.normalized();
    pose.rotation = product({std::cos(half), axis.x(), axis.y(), axis.z()}, pose.rotation);
    return pose;
}

bool obstacle_moves(const ObstacleSpec& obstacle) {
    return obstacle.motion.size() > 1 || (obstacle.spin && obstacle.spin->turns_per_s != 0.0);
}

}  // namespace percale::scenes
