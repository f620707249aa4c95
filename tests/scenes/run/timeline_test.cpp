#include "scenes/run/timeline.h"

#include "percale/error.h"
#include "scenes/format/scene_file.h"
#include "scenes/run/obstacle_motion.h"
#include "tests/scenes/run/rotation_difference.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::timeline_test {
namespace {

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

namespace {

/// The sheet held at one corner by a ball that moves 0.2 m/s upwards.
BuiltScene carried_sheet(const std::string& events) {
    const std::string text = small_scene() + "pin = { box = [[0, 0, 0], [0, 1, 0]], to = \"ball\" }\n" +
                             "[[obstacle]]\nname = \"ball\"\nshape = { sphere = { radius = 0.05 } }\nmotion = [ { time = 0, "
                             "translation = [-3, 0, 0] }, { time = 1, translation = [-3, 0.2, 0] } ]\n" +
                             events;
    const Override settings[] = {{"step.time_step", "0.01"}, {"step.detector", "brute_force"}};
    return build_scene(parse_scene(text, "t", settings));
}

}  // namespace

TEST_CASE("a pin on an obstacle goes with it until an event moves it or lets it go") {
    BuiltScene carried = carried_sheet("");
    Timeline timeline(carried);
    const Vec3 start = position(carried, 0);
    for (int n = 1; n <= 10; ++n) {
        run_steps(carried, timeline, 1);
        CHECK((position(carried, 0) - start - Vec3(0, 0.002 * n, 0)).norm() < 1e-12);
    }
    BuiltScene freed = carried_sheet(event(0.05, "unpin = { cloth = \"flag\", vertices = [0] }"));
    Timeline other(freed);
    run_steps(freed, other, 30);
    CHECK(position(freed, 0).y() < 0.01);
    BuiltScene moved = carried_sheet(event(0.05, "move = { cloth = \"flag\", vertices = [0], to = [0, 0, 0.01], over = 0.02 }"));
    Timeline third(moved);
    run_steps(moved, third, 20);
    CHECK((position(moved, 0) - start - Vec3(0, 0.01, 0.01)).norm() < 1e-12);
    // Which pins still go with it follows from how far the script has come.
    BuiltScene resumed =
        carried_sheet(event(0.05, "move = { cloth = \"flag\", vertices = [0], to = [0, 0, 0.01], over = 0.02 }"));
    Timeline fourth(resumed);
    resumed.simulation.restore(moved.simulation.save());
    fourth.go_on_from(resumed, third.state());
    run_steps(moved, third, 5);
    run_steps(resumed, fourth, 5);
    CHECK(resumed.simulation.state_hash() == moved.simulation.state_hash());
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

}  // namespace percale::scenes::test::timeline_test
