#include <algorithm>
#include <cmath>

#include "common/text.h"
#include "format/scene_file.h"
#include "run/run_scene.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/watched_run.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::rest_scene_test {

// Scenes with duration = "rest".

namespace {

constexpr double dt = 1.0 / 60.0, thickness = 0.005;
const Override until_rest{"duration", "rest"};

/// A sheet of 11 x 11 vertices that falls onto a ball, drapes over it and hangs.
std::string sheet_on_ball() {
    return R"(
duration = "rest"
[step]
time_step = 0.016666666666666666
[fabric.sheet]
area_density = 0.2
thickness = 0.005
springs = { structural = 200.0, shear = 100.0, bend = 2.0 }
spring_damping = 0.5
[[cloth]]
name = "sheet"
fabric = "sheet"
grid = { size = [0.4, 0.4], vertices = [11, 11] }
pose = { translation = [0.0, 0.12, 0.0] }
[[obstacle]]
name = "ball"
shape = { sphere = { radius = 0.1 } }
friction = 0.5
[output]
fps = 7.0
)";
}

/// A sheet that swings about two corners and loses nothing.
std::string pendulum() {
    return R"(
duration = "rest"
max_duration = 1.005
[step]
time_step = 0.01
scheme = "implicit_midpoint"
[fabric.sheet]
area_density = 0.2
springs = { structural = 100.0, shear = 50.0, bend = 0.1 }
spring_damping = 0.0
[[cloth]]
name = "still"
fabric = "sheet"
grid = { size = [0.3, 0.3], vertices = [3, 3] }
pose = { translation = [2.0, 0.0, 0.0] }
pin = "boundary"
[[cloth]]
name = "swing"
fabric = "sheet"
grid = { size = [0.3, 0.3], vertices = [4, 4] }
pin = [0, 3]
[output]
fps = 30.0
)";
}

Scene scene_of(const std::string& text, const std::vector<Override>& overrides = {}) { return parse_scene(text, "t", overrides); }

struct Ended {
    RunResult result;
    std::vector<double> frame_times;  // s
};

Ended run(const Scene& scene) {
    Ended ended;
    BuiltScene built = build_scene(scene);
    RunHooks hooks;
    hooks.frame = [&](const Frame& frame) {
        CHECK(frame.index == static_cast<int>(ended.frame_times.size()));
        ended.frame_times.push_back(frame.time);
    };
    ended.result = run_scene(built, hooks);
    REQUIRE(ended.result.rest.has_value());
    return ended;
}

/// The time at which the sheet is at rest on the box; the scene has to end then.
double time_of_rest(const std::string& more, const std::vector<Override>& overrides = {}) {
    std::vector<Override> all = {until_rest};
    all.insert(all.end(), overrides.begin(), overrides.end());
    const RunResult result = run(scene_of(sheet_on_box() + more, all)).result;
    CAPTURE(result.reason);
    CHECK(result.status == RunStatus::finished);
    CHECK(result.rest->at_rest);
    CHECK(result.rest->time == result.totals.simulated_s);
    return result.totals.simulated_s;
}

}  // namespace

TEST_CASE("a sheet on a ball ends by itself, and without sleep hardly moves from then on") {
    const Ended ended = run(scene_of(sheet_on_ball()));
    const RestFigures& rest = *ended.result.rest;
    CAPTURE(ended.result.reason, rest.time, rest.largest_speed);
    REQUIRE(ended.result.status == RunStatus::finished);
    CHECK(rest.at_rest);
    CHECK(ended.result.totals.simulated_s < 19.0);
    CHECK(ended.result.measures.intersections == 0);
    // What the proof of rest says: two hundredths of the weight, and no farther than 0.002 of the thickness from one place.
    CHECK(rest.force_over_weight < 0.02);
    CHECK(rest.largest_speed * dt < 0.004 * thickness);
    CHECK(rest.rms_speed <= rest.largest_speed);
    CHECK(rest.rms_speed > 0.0);

    BuiltScene awake =
        build_scene(scene_of(sheet_on_ball(), {{"duration", number_text(rest.time + 1.0)}, {"step.skip", "false"}}));
    std::vector<Vec3> then;
    double largest = 0.0;
    RunHooks hooks;
    hooks.step = [&](const StepReport& report, const Simulation& simulation) {
        const auto now = simulation.positions(awake.cloths[0]);
        if (then.empty() && report.time > rest.time - 0.5 * dt) then.assign(now.begin(), now.end());
        for (std::size_t i = 0; i < then.size(); ++i) largest = std::max(largest, (now[i] - then[i]).norm());
    };
    REQUIRE(run_scene(awake, hooks).status == RunStatus::finished);
    CHECK(largest > 0.0);
    CHECK(largest < 0.01 * thickness);
}

TEST_CASE("frames come at their times, and the last one shows the end, once") {
    for (const std::string fps : {"7", "60"}) {
        CAPTURE(fps);
        const Ended ended = run(scene_of(sheet_on_box(), {until_rest, {"output.fps", fps}}));
        REQUIRE(ended.result.status == RunStatus::finished);
        const double end = ended.result.totals.simulated_s, rate = std::stod(fps);
        CHECK(ended.frame_times.back() == end);
        CHECK(std::adjacent_find(ended.frame_times.begin(), ended.frame_times.end(), std::greater_equal<>()) ==
              ended.frame_times.end());
        for (std::size_t k = 0; k + 1 < ended.frame_times.size(); ++k) {
            CHECK(ended.frame_times[k] > static_cast<double>(k) / rate - 1e-9);
            CHECK(ended.frame_times[k] < static_cast<double>(k) / rate + dt);
        }
    }
}

TEST_CASE("a run ends at the first step after which all cloth is proven at rest") {
    const double rest = time_of_rest("");
    CHECK(rest > 0.5);
    CHECK(rest < 1.0);
    // One that sleeps does so from the next step on.
    BuiltScene going_on = build_scene(scene_of(sheet_on_box(), {{"duration", number_text(rest + 10.0 * dt)}}));
    const RunResult longer = run_scene(going_on);
    CHECK(longer.totals.sleeping_steps == 10);
    CHECK_FALSE(longer.rest.has_value());
}

TEST_CASE("a sheet over the edge between two triangles of a box comes to rest from wherever it falls") {
    // Vertices on its diagonal are as near to one triangle as to the other: each pushed in some steps, both in others.
    for (const std::string height : {"0.0151", "0.016", "0.017", "0.02", "0.03"}) {
        CAPTURE(height);
        CHECK(time_of_rest("", {{"cloth.sheet.pose", "{ translation = [0.0, " + height + ", 0.0] }"}}) < 1.0);
    }
}

TEST_CASE("a run does not end while something is to come") {
    const std::string event = "[[event]]\ntime = 6.0\n";
    // What changes nothing leaves the cloth asleep: the run ends with the step that it happens in.
    CHECK(time_of_rest(event + "gravity = [0.0, -9.81, 0.0]\n") == Approx(6.0 + dt));
    CHECK(time_of_rest(event + "gravity = [0.0, -5.0, 0.0]\n") > 6.5);
    CHECK(time_of_rest(event + "wind = [0.1, 0.0, 0.0]\n") > 6.5);
    CHECK(time_of_rest(event + "pin = { cloth = \"sheet\", vertices = [0] }\n") > 6.5);
    CHECK(time_of_rest(event + "move = { cloth = \"sheet\", vertices = [0], to = [0.0, 0.01, 0.0], over = 1.0 }\n",
                       {{"cloth.sheet.pin", "[0]"}}) > 7.5);
    CHECK(time_of_rest("[[seam]]\ncloths = [\"sheet\", \"sheet\"]\nvertices = [[0, 1]]\nduration = 2.0\nstiffness = 0.1\n") >
          2.5);
    // A keyframe that moves nothing, and one that does.
    for (const std::string height : {"-0.25", "-0.24"}) {
        CAPTURE(height);
        const double end = time_of_rest("", {{"obstacle.box.motion",
                                              "[{ time = 5.6, translation = [0.0, -0.25, 0.0] }, { time = "
                                              "6.0, translation = [0.0, " +
                                                  height + ", 0.0] }]"}});
        CHECK(end >= 6.0 - 1e-9);
        CHECK((end > 6.4) == (height == "-0.24"));
    }
}

TEST_CASE("a run that is not at rest at max_duration fails and says how it moves, and which cloth") {
    const Ended ended = run(scene_of(pendulum()));
    const RunResult& result = ended.result;
    const RestFigures& rest = *result.rest;
    CHECK(result.status == RunStatus::failed);
    CHECK(result.totals.simulated_s == Approx(1.005));
    CHECK(ended.frame_times.back() == result.totals.simulated_s);
    CHECK_FALSE(rest.at_rest);
    CHECK(rest.largest_speed == result.measures.speed_at_end);
    CHECK(rest.rms_speed == Approx(result.measures.rms_speed_at_end));
    CHECK(rest.force_over_weight > 0.02);
    CAPTURE(result.reason);
    CHECK(
        result.reason.starts_with("not at rest (still for half a second, its forces balanced) after 1 s, the longest that it may "
                                  "take: cloth 'swing' moves fastest, at "));
    CHECK(result.reason.find(" m/s rms; the largest net force on one is ") != std::string::npos);
    CHECK(result.reason.find("; step.kinetic_damping = true stops what swings") != std::string::npos);
    const std::string damped =
        run(scene_of(pendulum(), {{"step.kinetic_damping", "true"}, {"max_duration", "0.02"}})).result.reason;
    CHECK(damped.starts_with("not at rest"));
    CHECK(damped.find("kinetic_damping") == std::string::npos);
}

TEST_CASE("free fall is its own weight, and without gravity nothing is said of weight") {
    const std::vector<Override> implicit = {until_rest, {"max_duration", "0.1"}, {"step.scheme", "backward_euler"}};
    const RestFigures falling = *run(scene_of(falling_sheet(), implicit)).result.rest;
    CHECK(falling.force_over_weight == Approx(1.0).epsilon(1e-6));
    CHECK(falling.largest_speed == Approx(0.981).epsilon(1e-6));
    CHECK(falling.rms_speed == Approx(0.981).epsilon(1e-6));
    std::vector<Override> weightless = implicit;
    weightless.push_back({"gravity", "[0, 0, 0]"});
    const RunResult floating = run(scene_of(falling_sheet(), weightless)).result;
    CHECK(std::isnan(floating.rest->force_over_weight));
    CHECK(floating.reason.find("weight") == std::string::npos);
    // From an event on, gravity is another one.
    const std::string event = "[[event]]\ntime = 0.05\ngravity = [0.0, -2.0, 0.0]\n";
    const RestFigures slower = *run(scene_of(falling_sheet() + event, implicit)).result.rest;
    CHECK(slower.force_over_weight == Approx(1.0).epsilon(1e-6));
}

TEST_CASE("a scene that ends at rest is resumed in the same bits, from its last state, too") {
    const std::string event = "[[event]]\ntime = 1.2\ngravity = [0.5, -9.0, 0.0]\n";
    const std::vector<std::vector<Override>> ways = {
        {until_rest},
        {until_rest, {"output.fps", "7"}},
        {until_rest, {"max_duration", "1.5"}},  // fails
        {until_rest, {"max_duration", "1.5"}, {"output.fps", "7"}},
        {until_rest, {"step.time_step", "auto"}, {"step.tolerance", "0.01"}},
    };
    for (const std::vector<Override>& overrides : ways) {
        const Scene scene = scene_of(sheet_on_box() + event, overrides);
        const WatchedRun plain = watch(scene, {});
        CAPTURE(scene.max_duration, scene.output.fps, plain.result.reason);
        CHECK((plain.result.status == RunStatus::failed) == (scene.max_duration < 20.0));
        const WatchedRun left = watch(scene, {.checkpoint_every = dt});
        CHECK(plain.hashes == left.hashes);
        CHECK(plain.report == left.report);
        REQUIRE(left.states.size() > 60);
        CHECK(left.hashes_before.back() == plain.hashes.size());
        for (const std::size_t k : {std::size_t{3}, left.states.size() / 2, left.states.size() - 2, left.states.size() - 1}) {
            CAPTURE(k);
            CHECK(resumes_as(plain, left, k, watch(scene, {.from = &left.states[k]})));
        }
    }
}

}  // namespace percale::scenes::test::rest_scene_test
