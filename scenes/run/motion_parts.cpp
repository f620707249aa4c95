#include "run/motion_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "percale/cloth_ahead.h"
#include "run/obstacle_motion.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

/// Parts of a step. What moves still farther in a part may block the cloth.
constexpr double max_motion_parts = 1e5;

/// The time that two intervals have in common, s.
double overlap(double from, double to, double other_from, double other_to) {
    return std::max(0.0, std::min(to, other_to) - std::max(from, other_from));
}

ClothAhead cloth_ahead(const BuiltScene& built, std::size_t cloth, double dt) {
    ClothAhead ahead(built.scene.fabrics.at(built.scene.cloths[cloth].fabric).thickness, dt);
    const auto positions = built.simulation.positions(built.cloths[cloth]);
    const auto velocities = built.simulation.velocities(built.cloths[cloth]);
    for (std::size_t i = 0; i < positions.size(); ++i) ahead.add(positions[i], velocities[i]);
    return ahead;
}

/// Distance of the farthest vertex from the mesh's origin, m.
double reach_of(const BuiltScene& built, std::size_t obstacle) {
    double squared = 0.0;
    for (const Vec3& x : built.obstacle_meshes[obstacle].vertices) squared = std::max(squared, x.squaredNorm());
    return built.scene.obstacles[obstacle].pose.scale * std::sqrt(squared);
}

/// Parts that an obstacle's translation asks for, not rounded.
double parts_of_displacement(const BuiltScene& built, std::size_t obstacle, double path, double dt) {
    const ObstacleSpec& spec = built.scene.obstacles[obstacle];
    const double now = built.simulation.time();
    const Vec3 start = obstacle_pose_at(spec, now).translation, end = obstacle_pose_at(spec, now + dt).translation;
    const double reach = reach_of(built, obstacle);
    double parts = 0.0;
    for (std::size_t i = 0; i < built.cloths.size(); ++i) {
        const ClothAhead cloth = cloth_ahead(built, i, dt);
        if (!cloth.meets(start, end, reach)) continue;
        const double relative = path - (end - start).norm() + cloth.beside(end - start).norm();
        parts = std::max(parts, relative / (largest_part_displacement * cloth.thickness()));
    }
    return parts;
}

}  // namespace

MotionAmount motion_between(const ObstacleSpec& obstacle, double from, double to) {
    MotionAmount amount;
    Pose before = obstacle.pose;
    for (std::size_t i = 0; i < obstacle.motion.size(); ++i) {
        const Keyframe& frame = obstacle.motion[i];
        const Pose after{frame.translation.value_or(before.translation), frame.rotation.value_or(before.rotation)};
        if (i > 0) {
            const double first = obstacle.motion[i - 1].time, last = frame.time;
            const double share = overlap(from, to, first, last) / (last - first);
            amount.angle += share * angle_between(before.rotation, after.rotation);
            amount.path += share * (after.translation - before.translation).norm();
        }
        before = after;
    }
    if (!obstacle.spin) return amount;
    const double turning = std::max(0.0, to - std::max(from, obstacle.spin->from));
    amount.angle += 2.0 * std::numbers::pi * std::abs(obstacle.spin->turns_per_s) * turning;
    return amount;
}

int motion_parts(const BuiltScene& built, double dt) {
    const double now = built.simulation.time();
    double parts = 1.0;
    for (std::size_t i = 0; i < built.obstacles.size(); ++i) {
        const MotionAmount amount = motion_between(built.scene.obstacles[i], now, now + dt);
        parts = std::max(parts, amount.angle / largest_part_turn);
        if (amount.path > 0.0) parts = std::max(parts, parts_of_displacement(built, i, amount.path, dt));
    }
    return static_cast<int>(std::ceil(std::min(parts, max_motion_parts) - part_rounding));
}

}  // namespace percale::scenes
