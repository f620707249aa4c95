#include "scenes/run/run_verdict.h"

#include "format/scene_file.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::run_verdict_test {
namespace {

BuiltScene built(const std::string& text, const std::vector<Override>& overrides = {}) {
    return build_scene(parse_scene(text, "test.toml", overrides));
}

RunResult with_crossing(RunStatus status = RunStatus::finished, const std::string& reason = "") {
    RunResult result;
    result.status = status;
    result.reason = reason;
    add_frame(result.measures, 4, {.intersections = 1, .smallest_distance = 0.0});
    add_frame(result.measures, 7,
              {.intersections = 2, .vertices_inside = 1, .deepest_penetration = 0.002, .smallest_distance = 0.0});
    return result;
}

RunResult certified(int intersections, double depth) {
    RunResult result;
    result.measures.steps.emplace();
    add_state(*result.measures.steps, 12, 0.2,
              {.intersections = intersections, .deepest_penetration = depth, .smallest_distance = 0.0});
    return result;
}

}  // namespace

TEST_CASE("a run in which nothing crosses and every step was solved is finished, without a reason") {
    const RunVerdict verdict = verdict_of_run({});
    CHECK(verdict.word == "finished");
    CHECK(verdict.well());
}

TEST_CASE("a crossing in any frame is the run's status, with how many, where and how deep") {
    const RunVerdict verdict = verdict_of_run(with_crossing());
    CHECK(verdict.word == "crossed");
    CHECK(verdict.reason == "3 pairs of triangles cross, summed over the frames, most in frame 7, 0.002 m deep");
    RunResult swallowed;
    add_frame(swallowed.measures, 3, {.vertices_inside = 9, .deepest_penetration = 0.05});
    CHECK(verdict_of_run(swallowed).word == "crossed");
    CHECK(verdict_of_run(swallowed).reason.find("0.05 m deep") != std::string::npos);
}

TEST_CASE("of states between frames, too, where they were certified") {
    CHECK(verdict_of_run(certified(0, 0.0)).well());
    CHECK(verdict_of_run(certified(1, 0.0)).reason ==
          "1 pair of triangles crosses, summed over the states, most after step 12 (0.2 s)");
    CHECK(verdict_of_run(certified(0, 0.01)).word == "crossed");
}

TEST_CASE(
    "a stopped run keeps its word, by which it is taken up again; one that failed has crossed first; all is in the reason") {
    RunResult stopped = with_crossing(RunStatus::stopped, "stopped at 1 of 2 s");
    stopped.totals.unsolved_steps = 1;
    CHECK(verdict_of_run(stopped).word == "stopped");
    CHECK(verdict_of_run(stopped).reason == "stopped at 1 of 2 s; " + crossing_text(stopped.measures) + "; " + unsolved_text(1));
    const RunVerdict failed = verdict_of_run(with_crossing(RunStatus::failed, "blocked"));
    CHECK(failed.word == "crossed");
    CHECK(failed.reason.starts_with("blocked; 3 pairs"));
    RunResult unsolved;
    unsolved.totals.unsolved_steps = 2;
    CHECK(verdict_of_run(unsolved).word == "unsolved");
    CHECK(verdict_of_run(unsolved).reason == "2 steps were taken unsolved (not_converged or tolerance_missed)");
    unsolved.status = RunStatus::failed;
    unsolved.reason = "blocked";
    CHECK(verdict_of_run(unsolved).word == "failed");
}

TEST_CASE("a run whose steps end at the limit of iterations is unsolved") {
    BuiltScene scene = built(sheet_on_box());
    CHECK(verdict_of_run(run_scene(scene)).well());
    BuiltScene hurried = built(sheet_on_box(), {{"step.newton_iterations", "2"}, {"step.newton_tolerance", "1e-12"}});
    const RunResult result = run_scene(hurried);
    CHECK(result.totals.unsolved_steps > 0);
    CHECK(verdict_of_run(result).word == "unsolved");
}

}  // namespace percale::scenes::test::run_verdict_test
