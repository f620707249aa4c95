#include "scenes/run/timeline.h"

#include <cmath>
#include <numbers>

#include "percale/error.h"
#include "scenes/format/scene_file.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

using namespace percale;
using namespace percale::scenes;

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

// How far apart the images of the three axes are: 0 for the same turn, whatever the quaternion's sign.
double difference(const Rotation& a, const Rotation& b) {
    double largest = 0.0;
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        largest = std::max(largest, (transform({.translation = Vec3::Zero(), .rotation = a}, axis) -
                                     transform({.translation = Vec3::Zero(), .rotation = b}, axis))
                                        .norm());
    return largest;
}

ObstacleSpec moving(std::vector<Keyframe> motion) {
    ObstacleSpec obstacle;
    obstacle.pose = {.translation = Vec3(1, 2, 3), .rotation = turn_about({0, 0, 1}, 0.3), .scale = 2.0};
    obstacle.motion = std::move(motion);
    return obstacle;
}

constexpr double dt = 0.01;

// A free sheet of 3 by 3 vertices without damping, explicit steps of 0.01 s, vertex 0 pinned.
BuiltScene sheet(const std::string& events) {
    const std::string text =
        "duration = 1\n[step]\ntime_step = 0.01\nscheme = \"symplectic_euler\"\ndamping_form = \"velocity\"\n"
        "[fabric.sheet]\nspring_damping = 0\nsprings = { structural = 10, shear = 5, bend = 1 }\n"
        "[[cloth]]\nname = \"flag\"\nfabric = \"sheet\"\ngrid = { size = [1, 1], vertices = [3, 3] }\npin = [0]\n";
    return build_scene(parse_scene(text + events, "t"));
}

std::string event(double time, const std::string& what) {
    return "[[event]]\ntime = " + std::to_string(time) + "\n" + what + "\n";
}

std::string move(int vertex, const std::string& to, const std::string& over) {
    return "move = { cloth = \"flag\", vertices = [" + std::to_string(vertex) + "], to = " + to + ", over = " + over + " }";
}

void run_steps(BuiltScene& built, Timeline& timeline, int count) {
    for (int i = 0; i < count; ++i) {
        timeline.apply(built, built.simulation.time(), dt);
        REQUIRE(built.simulation.step().ok());
    }
}

Vec3 position(const BuiltScene& built, std::size_t vertex) { return built.simulation.positions(built.cloths[0])[vertex]; }

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

TEST_CASE("an event happens before the first step that starts at or after its time") {
    const std::string unpin = "unpin = { cloth = \"flag\", vertices = [0] }";
    // 0.05 is also reached as a sum of five steps of 0.01, which is not the same number.
    BuiltScene at_step = sheet(event(0.05, unpin));
    Timeline timeline(at_step);
    const Vec3 start = position(at_step, 0);
    run_steps(at_step, timeline, 5);
    CHECK(position(at_step, 0) == start);
    run_steps(at_step, timeline, 1);
    CHECK(position(at_step, 0).y() < start.y());

    BuiltScene within_step = sheet(event(0.041, unpin));
    Timeline other(within_step);
    run_steps(within_step, other, 5);
    CHECK(position(within_step, 0) == start);
    run_steps(within_step, other, 1);
    CHECK(position(within_step, 0).y() < start.y());
}

TEST_CASE("an event at the start comes before the first step") {
    BuiltScene built = sheet(event(0.0, "unpin = { cloth = \"flag\", vertices = [0] }"));
    Timeline timeline(built);
    run_steps(built, timeline, 10);
    // Free fall by steps of v += g dt, x += v dt: y = -g dt^2 n (n + 1)/2
    for (std::size_t i = 0; i < 9; ++i) CHECK(position(built, i).y() == Approx(-9.81 * dt * dt * 55.0).epsilon(1e-12));
}

TEST_CASE("gravity changes from the event on") {
    BuiltScene built =
        sheet(event(0.0, "unpin = { cloth = \"flag\", vertices = [0] }") + event(0.03, "gravity = [1.0, 0.0, 0.0]"));
    Timeline timeline(built);
    run_steps(built, timeline, 5);
    const Vec3 v = built.simulation.velocities(built.cloths[0])[4];
    CHECK(v.y() == Approx(-9.81 * 0.03).epsilon(1e-12));
    CHECK(v.x() == Approx(0.02).epsilon(1e-12));
}

TEST_CASE("a vertex pinned by an event stays where it is then") {
    BuiltScene built = sheet(event(0.05, "pin = { cloth = \"flag\", vertices = [8] }"));
    Timeline timeline(built);
    run_steps(built, timeline, 5);
    const Vec3 held = position(built, 8);
    CHECK(held.y() < 0.0);
    run_steps(built, timeline, 5);
    CHECK(position(built, 8) == held);
}

TEST_CASE("a moved pin is on its straight line at every step and arrives when its time is over") {
    BuiltScene built = sheet(event(0.02, move(0, "[0.0, 0.4, 0.2]", "0.08")));
    Timeline timeline(built);
    const Vec3 start = position(built, 0);
    run_steps(built, timeline, 2);
    CHECK(position(built, 0) == start);
    for (int step = 1; step <= 8; ++step) {
        run_steps(built, timeline, 1);
        CHECK((position(built, 0) - start - step / 8.0 * Vec3(0.0, 0.4, 0.2)).norm() < 1e-12);
    }
    run_steps(built, timeline, 3);
    CHECK((position(built, 0) - start - Vec3(0.0, 0.4, 0.2)).norm() < 1e-12);
}

TEST_CASE("a move that begins inside a step is on time at the step's end") {
    BuiltScene built = sheet(event(0.005, move(0, "[0.1, 0.0, 0.0]", "0.1")));
    Timeline timeline(built);
    const Vec3 start = position(built, 0);
    run_steps(built, timeline, 3);
    CHECK((position(built, 0) - start - Vec3(0.025, 0, 0)).norm() < 1e-12);
}

TEST_CASE("a later move of a vertex replaces the earlier from where the vertex is") {
    BuiltScene built = sheet(event(0.0, move(0, "[0.4, 0.0, 0.0]", "0.08")) + event(0.04, move(0, "[0.0, 0.1, 0.0]", "0.02")));
    Timeline timeline(built);
    const Vec3 start = position(built, 0);
    run_steps(built, timeline, 10);
    CHECK((position(built, 0) - start - Vec3(0.2, 0.1, 0.0)).norm() < 1e-12);
}

TEST_CASE("a vertex that is let go during its move is free") {
    BuiltScene built =
        sheet(event(0.0, move(0, "[0.0, 0.8, 0.0]", "0.8")) + event(0.02, "unpin = { cloth = \"flag\", vertices = [0] }"));
    Timeline timeline(built);
    run_steps(built, timeline, 20);
    CHECK(position(built, 0).y() < 0.02);
}

TEST_CASE("a move of a free vertex is refused before anything runs") {
    CHECK(error_of([] { sheet(event(0.5, move(4, "[0, 1, 0]", "1"))); }).find("vertex 4 of cloth 'flag' is not pinned then") !=
          std::string::npos);
}

TEST_CASE("a moving obstacle is where its motion says at the end of every step, and one that rests is left alone") {
    const std::string body =
        "[[obstacle]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\n"
        "motion = [ { time = 0.02, translation = [0, 5, 0] }, { time = 0.06, translation = [0.004, 5, 0] } ]\n"
        "spin = { turns_per_s = 0.1, from = 0.03 }\n"
        "[[obstacle]]\nname = \"rock\"\nshape = { sphere = { radius = 0.1 } }\npose = { translation = [3, 5, 0] }\n";
    const std::string text = small_scene() + body;
    const Override settings[] = {{"step.time_step", "0.01"}, {"step.detector", "brute_force"}};
    BuiltScene built = build_scene(parse_scene(text, "t", settings));
    Timeline timeline(built);
    for (int i = 0; i < 10; ++i) {
        run_steps(built, timeline, 1);
        const Pose expected = obstacle_pose_at(built.scene.obstacles[0], built.simulation.time());
        const Pose actual = built.simulation.obstacle_pose(built.obstacles[0]);
        CHECK((actual.translation - expected.translation).norm() < 1e-12);
        CHECK(difference(actual.rotation, expected.rotation) < 1e-12);
        CHECK(built.simulation.obstacle_pose(built.obstacles[1]).translation == Vec3(3, 5, 0));
    }
    CHECK((built.simulation.obstacle_pose(built.obstacles[0]).translation - Vec3(0.004, 5, 0)).norm() < 1e-15);
}

TEST_CASE("a script goes on where another one stands, in the midst of a move") {
    const std::string events = event(0.015, move(0, "[0, 1, 0]", "0.1")) + event(0.035, "gravity = [0, 0, 0]") +
                               event(0.075, "unpin = { cloth = \"flag\", vertices = [0] }");
    BuiltScene plain = sheet(events), left = sheet(events), resumed = sheet(events);
    Timeline whole(plain), first(left), second(resumed);
    run_steps(plain, whole, 12);
    run_steps(left, first, 5);
    REQUIRE(first.state().moving_pins.size() == 1);
    CHECK(first.state().next_event == 2);
    resumed.simulation.restore(left.simulation.save());
    second.go_on_from(resumed, first.state());
    run_steps(resumed, second, 7);
    CHECK(resumed.simulation.state_hash() == plain.simulation.state_hash());
}

TEST_CASE("the state of another scene's script is refused") {
    BuiltScene built = sheet(event(0.1, "gravity = [0, 0, 0]"));
    Timeline timeline(built);
    CHECK_THROWS_AS(timeline.go_on_from(built, {.next_event = 2, .moving_pins = {}}), SceneError);
    CHECK_THROWS_AS(timeline.go_on_from(built, {.next_event = -1, .moving_pins = {}}), SceneError);
    CHECK_THROWS_AS(timeline.go_on_from(built, {.next_event = 0, .moving_pins = {{.cloth = 0, .vertex = 9}}}), SceneError);
    CHECK_THROWS_AS(timeline.go_on_from(built, {.next_event = 0, .moving_pins = {{.cloth = 1, .vertex = 0}}}), SceneError);
    CHECK_NOTHROW(timeline.go_on_from(built, {.next_event = 1, .moving_pins = {{.cloth = 0, .vertex = 8}}}));
}
