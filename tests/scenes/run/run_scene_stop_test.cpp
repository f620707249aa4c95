#include <atomic>
#include <vector>

#include "format/scene_file.h"
#include "run/run_scene.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::run_scene_stop_test {

TEST_CASE("a stop is heard after a step, and the run says how far it came") {
    BuiltScene built = build_scene(parse_scene(falling_sheet(), "test.toml"));
    int steps = 0;
    RunHooks hooks;
    hooks.step = [&](const StepReport&, const Simulation&) { ++steps; };
    hooks.stop_asked = [&] { return steps == 3; };
    const RunResult result = run_scene(built, hooks);
    CHECK(result.status == RunStatus::stopped);
    CHECK(steps == 3);
    CHECK(result.totals.steps == 3);
    CHECK(result.totals.simulated_s == Approx(0.03));
    CHECK(result.reason.find("stopped at 0.03 of 0.1 s") != std::string::npos);
}

TEST_CASE("a certificate is not waited for: its frame is missing, the steps before it count") {
    BuiltScene built = build_scene(parse_scene(sheet_on_box(), "test.toml", std::vector<Override>{{"output.fps", "1"}}));
    std::atomic<bool> cancel = false;
    int steps = 0, frames = 0;
    RunHooks hooks;
    hooks.cancel = &cancel;
    hooks.step = [&](const StepReport&, const Simulation&) { cancel = ++steps == 3; };
    hooks.frame = [&](const Frame&) { ++frames; };
    const RunResult result = run_scene(built, hooks, {.certify_steps = true});
    CHECK(result.status == RunStatus::stopped);
    CHECK_THAT(result.reason, Catch::Contains(", before its state was certified"));
    CHECK(result.totals.steps == 3);
    CHECK(result.measures.steps->states == 3);
    CHECK(frames == 1);
}

}  // namespace percale::scenes::test::run_scene_stop_test
