#include "run/obstacle_motion.h"

#include <cmath>
#include <numbers>

namespace percale::scenes {
namespace {

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
            return interpolate(before, after, f);
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
    return obstacle.motion.size() > 1 || obstacle.bends() || (obstacle.spin && obstacle.spin->turns_per_s != 0.0);
}

}  // namespace percale::scenes
