#include "format/scene_file.h"
#include "percale/error.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/watched_run.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::resume_scene_test {

// Runs of scenes that are left on their way and resumed with the scene built anew.

namespace {

/// Checks that a run resumes alike after every quarter of its duration.
void check_resumes(const Scene& scene, bool certify_steps) {
    const WatchedRun plain = watch(scene, {.certify_steps = certify_steps});
    const WatchedRun left = watch(scene, {.certify_steps = certify_steps, .checkpoint_every = 0.25 * scene.duration});
    CHECK(plain.states.empty());
    CHECK(plain.hashes == left.hashes);
    CHECK(plain.report == left.report);
    REQUIRE(left.states.size() >= 3);
    for (std::size_t k = 0; k < left.states.size(); ++k) {
        CAPTURE(k);
        CHECK(resumes_as(plain, left, k, watch(scene, {.certify_steps = certify_steps, .from = &left.states[k]})));
    }
}

/// Checks it where every step is measured and where frames are.
void check_resumes(const std::string& text, const std::vector<Override>& overrides, bool certify_steps = false) {
    for (const std::string measures : {"ledger", "auto"}) {
        CAPTURE(measures);
        std::vector<Override> measured = overrides;
        measured.push_back({"step.measure", measures});
        check_resumes(parse_scene(text, "test.toml", measured), certify_steps);
    }
}

/// Something of every kind happens while pins are on their way.
std::string with_events(const std::string& text) {
    return text + R"(
[[event]]
time = 0.03
move = { cloth = "sheet", vertices = [0], to = [0.0, 0.02, 0.01], over = 0.09 }
[[event]]
time = 0.05
wind = [2.0, 0.0, 0.5]
[[event]]
time = 0.09
gravity = [0.5, -9.0, 0.0]
[[event]]
time = 0.16
unpin = { cloth = "sheet", vertices = [0] }
)";
}

const std::string turning = R"(spin = { axis = [0.0, 1.0, 0.0], turns_per_s = 5.0, from = 0.04 }
)";

/// The box turns, so fast that steps are made in parts.
std::string with_spin(std::string text) {
    text.insert(text.find("[output]"), turning);
    return text;
}

const Override pinned{"cloth.sheet.pin", "[0]"};

}  // namespace

TEST_CASE("a scene that falls is resumed in the same bits") { check_resumes(falling_sheet(), {}); }

TEST_CASE("a scene with contact is resumed in the same bits, whatever finds and makes the contacts") {
    for (const std::string detector : {"\"fcl\"", "\"bullet\"", "\"brute_force\""}) {
        for (const std::string response : {"\"penalty\"", "\"projection\""}) {
            CAPTURE(detector, response);
            check_resumes(sheet_on_box(), {{"step.detector", detector}, {"step.contact_response", response}});
        }
    }
}

TEST_CASE("a scene with certified steps is resumed with the sums of its certificates") {
    check_resumes(sheet_on_box(), {}, true);
}

TEST_CASE("a scene is resumed in the midst of events and moved pins") {
    check_resumes(with_events(sheet_on_box()), {pinned});
    check_resumes(with_events(sheet_on_box()), {pinned, {"step.scheme", "\"tr_bdf2\""}});
}

TEST_CASE("a scene is resumed between parts of fast motion and between adaptive steps") {
    check_resumes(with_spin(sheet_on_box()), {});
    check_resumes(with_events(with_spin(sheet_on_box())), {pinned, {"step.time_step", "\"auto\""}, {"step.tolerance", "0.01"}});
}

TEST_CASE("a run that was resumed is left and resumed again") {
    const Scene scene = parse_scene(sheet_on_box(), "test.toml");
    const WatchedRun plain = watch(scene, {});
    const WatchedRun first = watch(scene, {.checkpoint_every = 0.05});
    const WatchedRun second = watch(scene, {.checkpoint_every = 0.05, .from = &first.states[0]});
    REQUIRE(second.states.size() == first.states.size() - 1);
    const WatchedRun third = watch(scene, {.from = &second.states[1]});
    CHECK(ends_with(plain.hashes, third.hashes));
    REQUIRE(third.result.resumed_at.size() == 2);
    CHECK(third.result.resumed_at[0] < third.result.resumed_at[1]);
}

TEST_CASE("a run that is stopped hands out the state in which it was stopped") {
    const Scene scene = parse_scene(sheet_on_box(), "test.toml");
    BuiltScene built = build_scene(scene);
    std::vector<RunState> states;
    int steps = 0;
    RunHooks hooks;
    hooks.step = [&](const StepReport&, const Simulation&) { ++steps; };
    hooks.stop_asked = [&] { return steps == 5; };
    hooks.checkpoint = [&](const RunState& state) { states.push_back(state); };
    CHECK(run_scene(built, hooks).status == RunStatus::stopped);
    REQUIRE(states.size() == 1);
    CHECK(states[0].totals.steps == 5);
    const WatchedRun plain = watch(scene, {}), resumed = watch(scene, {.from = &states[0]});
    CHECK(resumed.hashes.size() == plain.hashes.size() - 10);
    CHECK(ends_with(plain.hashes, resumed.hashes));
}

TEST_CASE("a state of another scene is refused by the name of its file before anything is begun") {
    const WatchedRun left = watch(parse_scene(sheet_on_box(), "test.toml"), {.checkpoint_every = 0.05});
    BuiltScene other = build_scene(parse_scene(falling_sheet(), "test.toml"));
    RunHooks hooks;
    bool begun = false;
    hooks.begin = [&] { begun = true; };
    CHECK_THROWS_WITH(run_scene(other, hooks, {.from = &left.states[0], .from_file = "a.percale"}),
                      Catch::StartsWith("a.percale: saved state: it is of other cloth"));
    CHECK_FALSE(begun);
}

}  // namespace percale::scenes::test::resume_scene_test
