#include "scenes/run/motion_parts.h"

#include <cmath>
#include <numbers>

#include "scenes/format/scene_file.h"
#include "scenes/run/obstacle_motion.h"
#include "tests/support/catch.h"
#include "tests/support/random.h"

namespace percale::scenes::test::motion_parts_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A sheet of thickness 5 mm about the origin and a ball of radius 0.1 m, 0.5 m above it unless `motion` says otherwise.
BuiltScene ball_and_sheet(const std::string& motion) {
    const std::string text =
        "[fabric.sheet]\nthickness = 0.005\nsprings = { structural = 100 }\n"
        "[[cloth]]\nname = \"sheet\"\nfabric = \"sheet\"\ngrid = { size = [1, 1], vertices = [5, 5] }\n"
        "[[obstacle]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\npose = { translation = [0, 0.5, 0] }\n";
    return build_scene(parse_scene(text + motion + "\n", "t"));
}

std::string path(const Vec3& from, const Vec3& to, double seconds) {
    const auto point = [](const Vec3& x) {
        return "[" + std::to_string(x[0]) + ", " + std::to_string(x[1]) + ", " + std::to_string(x[2]) + "]";
    };
    return "motion = [ { time = 0, translation = " + point(from) + " }, { time = " + std::to_string(seconds) +
           ", translation = " + point(to) + " } ]";
}

/// The angle of the turn between two poses, rad.
double turn(const Pose& a, const Pose& b) {
    const Rotation &p = a.rotation, &q = b.rotation;
    return 2.0 * std::acos(std::min(1.0, std::abs(p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z)));
}

}  // namespace

TEST_CASE("an obstacle that stays, or moves little, takes a step in one part") {
    CHECK(motion_parts(ball_and_sheet(""), 1.0) == 1);
    CHECK(motion_parts(ball_and_sheet("spin = { turns_per_s = 0.5 }"), 0.04) == 1);
    CHECK(motion_parts(ball_and_sheet(path({0, 0.3, 0}, {0, 0.2, 0}, 1.0)), 0.1) == 1);
}

TEST_CASE("a part of a step holds at most 15 degrees of a turn") {
    // 50 turns a second are 300 degrees in 1/60 s.
    CHECK(motion_parts(ball_and_sheet("spin = { turns_per_s = 50 }"), 1.0 / 60.0) == 20);
    CHECK(motion_parts(ball_and_sheet("spin = { turns_per_s = -50 }"), 1.0 / 60.0) == 20);
    // Only what lies after its beginning counts.
    CHECK(motion_parts(ball_and_sheet("spin = { turns_per_s = 50, from = 0.005 }"), 0.01) == 6);
    // Keyframes a half turn apart, half of the time between them.
    CHECK(motion_parts(ball_and_sheet("motion = [ { time = 0 }, { time = 0.1, rotation = [0, 0, 1, 0] } ]"), 0.05) == 6);
}

TEST_CASE("near cloth a part holds at most four thicknesses of an obstacle's displacement, elsewhere any") {
    // 1 m in 0.1 s, all of it within a step of 0.2 s: 1 m / 0.02 m.
    CHECK(motion_parts(ball_and_sheet(path({0, 0.5, 0}, {0, -0.5, 0}, 0.1)), 0.2) == 50);
    // The way there and back counts, though the ends are one place.
    const std::string back =
        "motion = [ { time = 0, translation = [0, 0.2, 0] }, { time = 0.1, translation = [0, 0.15, 0] }, "
        "{ time = 0.2, translation = [0, 0.2, 0] } ]";
    BuiltScene nearer = ball_and_sheet(back);
    CHECK(motion_between(nearer.scene.obstacles[0], 0.0, 0.2).path == Approx(0.1));
    CHECK(motion_parts(ball_and_sheet(path({0, 5.5, 0}, {0, 4.5, 0}, 0.1)), 0.2) == 1);
}

TEST_CASE("only motion relative to the cloth counts: what travels with it needs no parts") {
    BuiltScene built = ball_and_sheet(path({0, 0.102, 0}, {10, 0.102, 0}, 1.0));
    CHECK(motion_parts(built, 0.1) == 50);
    built.simulation.set_velocities(built.cloths[0], std::vector<Vec3>(25, Vec3(10.0, 0.0, 0.0)));
    CHECK(motion_parts(built, 0.1) == 1);
    built.simulation.set_velocities(built.cloths[0], std::vector<Vec3>(25, Vec3(-10.0, 0.0, 0.0)));
    CHECK(motion_parts(built, 0.1) == 100);
}

TEST_CASE("parts are never without number") {
    CHECK(motion_parts(ball_and_sheet("spin = { turns_per_s = 1000 }"), 1e6) == 100000);
}

TEST_CASE("the poses of random motions never turn or move by more than the amount said") {
    percale::test::Random random(71);
    for (int trial = 0; trial < 200; ++trial) {
        ObstacleSpec obstacle;
        obstacle.pose = random.pose(1.0);
        double time = 0.0;
        for (int k = random.index(4); k > 0; --k) {
            time += random.number(0.05, 0.5);
            const Pose pose = random.pose(1.0);
            obstacle.motion.push_back({time, pose.translation, pose.rotation});
        }
        if (random.index(2) == 0) obstacle.spin = Spin{random.unit(), random.number(-0.2, 0.2), random.number(0.0, 1.0)};
        const double from = random.number(0.0, 1.0), to = from + random.number(0.0, 1.0);
        const MotionAmount amount = motion_between(obstacle, from, to);
        const Pose start = obstacle_pose_at(obstacle, from), end = obstacle_pose_at(obstacle, to);
        CHECK(amount.angle >= turn(start, end) - 1e-6);
        CHECK(amount.path >= (end.translation - start.translation).norm() - 1e-12);
        if (obstacle.motion.empty() && amount.angle < pi) CHECK(amount.angle == Approx(turn(start, end)).margin(1e-6));
    }
}

}  // namespace percale::scenes::test::motion_parts_test
