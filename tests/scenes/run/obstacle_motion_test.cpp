#include "scenes/run/obstacle_motion.h"

#include <cmath>
#include <numbers>

#include "tests/scenes/run/rotation_difference.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::obstacle_motion_test {
namespace {

constexpr double pi = std::numbers::pi;

Rotation turn_about(const Vec3& axis, double angle) {
    const Vec3 u = std::sin(0.5 * angle) * axis.normalized();
    return {std::cos(0.5 * angle), u.x(), u.y(), u.z()};
}

Keyframe key(double time, std::optional<Vec3> translation, std::optional<Rotation> rotation = {}) {
    return {time, translation, rotation};
}

double length(const Rotation& r) { return std::sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z); }

ObstacleSpec moving(std::vector<Keyframe> motion) {
    ObstacleSpec obstacle;
    obstacle.pose = {.translation = Vec3(1, 2, 3), .rotation = turn_about({0, 0, 1}, 0.3), .scale = 2.0};
    obstacle.motion = std::move(motion);
    return obstacle;
}

}  // namespace

TEST_CASE("an obstacle without motion stays in its pose") {
    const ObstacleSpec still = moving({});
    for (const double time : {0.0, 0.5, 100.0}) {
        const Pose pose = obstacle_pose_at(still, time);
        CHECK(pose.translation == still.pose.translation);
        CHECK(pose.rotation.w == still.pose.rotation.w);
        CHECK(pose.scale == 2.0);
    }
}

TEST_CASE("keyframes replace translation and rotation, are linear in between and constant outside, the scale stays") {
    const ObstacleSpec obstacle = moving({key(1.0, Vec3(0, 0, 0)), key(3.0, Vec3(4, -2, 0))});
    CHECK(obstacle_pose_at(obstacle, 0.0).translation == Vec3(0, 0, 0));
    CHECK(obstacle_pose_at(obstacle, 1.0).translation == Vec3(0, 0, 0));
    CHECK((obstacle_pose_at(obstacle, 1.5).translation - Vec3(1, -0.5, 0)).norm() < 1e-15);
    CHECK(obstacle_pose_at(obstacle, 3.0).translation == Vec3(4, -2, 0));
    CHECK(obstacle_pose_at(obstacle, 9.0).translation == Vec3(4, -2, 0));
    CHECK(obstacle_pose_at(obstacle, 1.5).scale == 2.0);
}

TEST_CASE("what a keyframe does not say stays as the one before, and first as the pose has it") {
    const Rotation quarter = turn_about({0, 1, 0}, 0.5 * pi);
    const ObstacleSpec obstacle = moving({key(0.0, std::nullopt), key(1.0, Vec3(0, 0, 0)), key(2.0, std::nullopt, quarter)});
    CHECK(obstacle_pose_at(obstacle, 0.0).translation == Vec3(1, 2, 3));
    CHECK(difference(obstacle_pose_at(obstacle, 1.0).rotation, obstacle.pose.rotation) == 0.0);
    CHECK(obstacle_pose_at(obstacle, 1.5).translation == Vec3(0, 0, 0));
    CHECK(difference(obstacle_pose_at(obstacle, 2.0).rotation, quarter) == 0.0);
}

TEST_CASE("between two rotations the obstacle turns evenly about one axis") {
    const Vec3 axis(1.0, -2.0, 0.5);
    for (const double angle : {1e-7, 1e-3, 0.4, 0.5 * pi, 3.0}) {
        const ObstacleSpec obstacle =
            moving({key(0.0, Vec3::Zero(), turn_about(axis, 0.2)), key(1.0, {}, turn_about(axis, 0.2 + angle))});
        for (const double time : {0.1, 0.25, 0.5, 0.9}) {
            const Rotation r = obstacle_pose_at(obstacle, time).rotation;
            CAPTURE(angle, time);
            CHECK(difference(r, turn_about(axis, 0.2 + time * angle)) < 1e-14);
            CHECK(length(r) == Approx(1.0).epsilon(1e-14));
        }
    }
}

TEST_CASE("an obstacle turns the shortest way, whatever the sign of the quaternions") {
    const Rotation end = turn_about({0, 1, 0}, 1.0);
    const Rotation same_end = {-end.w, -end.x, -end.y, -end.z};
    const ObstacleSpec plus = moving({key(0.0, Vec3::Zero(), Rotation{}), key(1.0, {}, end)});
    const ObstacleSpec minus = moving({key(0.0, Vec3::Zero(), Rotation{}), key(1.0, {}, same_end)});
    CHECK(difference(obstacle_pose_at(minus, 0.5).rotation, turn_about({0, 1, 0}, 0.5)) < 1e-14);
    CHECK(difference(obstacle_pose_at(plus, 0.3).rotation, obstacle_pose_at(minus, 0.3).rotation) < 1e-14);
    const ObstacleSpec long_way = moving({key(0.0, Vec3::Zero(), Rotation{}), key(1.0, {}, turn_about({0, 1, 0}, 1.5 * pi))});
    CHECK(difference(obstacle_pose_at(long_way, 0.5).rotation, turn_about({0, 1, 0}, -0.25 * pi)) < 1e-14);
}

TEST_CASE("a spin turns about a world axis through the mesh's origin, from its time on") {
    ObstacleSpec obstacle = moving({});
    obstacle.spin = Spin{.axis = Vec3(0, 1, 0), .turns_per_s = 0.5, .from = 1.0};
    CHECK(difference(obstacle_pose_at(obstacle, 0.5).rotation, obstacle.pose.rotation) == 0.0);
    CHECK(difference(obstacle_pose_at(obstacle, 3.0).rotation, obstacle.pose.rotation) < 1e-14);
    // A quarter turn about y takes x to -z.
    const Pose quarter = obstacle_pose_at(obstacle, 1.5);
    const Vec3 before = transform(obstacle.pose, Vec3(1, 0, 0)) - obstacle.pose.translation;
    const Vec3 after = transform(quarter, Vec3(1, 0, 0)) - quarter.translation;
    CHECK((after - Vec3(before.z(), before.y(), -before.x())).norm() < 1e-14);
    CHECK(quarter.translation == obstacle.pose.translation);
    CHECK(quarter.scale == 2.0);
}

TEST_CASE("a spin comes on top of keyframes") {
    ObstacleSpec obstacle = moving({key(0.0, Vec3::Zero(), Rotation{}), key(2.0, Vec3(2, 0, 0))});
    obstacle.spin = Spin{.axis = Vec3(0, 0, 3), .turns_per_s = 1.0, .from = 0.0};
    const Pose pose = obstacle_pose_at(obstacle, 1.25);
    CHECK((pose.translation - Vec3(1.25, 0, 0)).norm() < 1e-15);
    CHECK(difference(pose.rotation, turn_about({0, 0, 1}, 0.5 * pi)) < 1e-14);
}

TEST_CASE("an obstacle moves if it has several keyframes or turns") {
    CHECK_FALSE(obstacle_moves(moving({})));
    CHECK_FALSE(obstacle_moves(moving({key(1.0, Vec3(0, 1, 0))})));
    CHECK(obstacle_moves(moving({key(1.0, Vec3(0, 1, 0)), key(2.0, Vec3(0, 0, 0))})));
    ObstacleSpec turning = moving({});
    turning.spin = Spin{.axis = Vec3::UnitY(), .turns_per_s = 0.5, .from = 1.0};
    CHECK(obstacle_moves(turning));
    turning.spin->turns_per_s = 0.0;
    CHECK_FALSE(obstacle_moves(turning));
}

}  // namespace percale::scenes::test::obstacle_motion_test
