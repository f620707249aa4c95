#include "scenes/measures/timed_measures.h"

#include <cmath>

#include "scenes/format/expectations.h"
#include "scenes/format/scene_file.h"
#include "scenes/run/run_scene.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::timed_measures_test {
namespace {

struct Judged {
    RunResult result;
    std::vector<ExpectationResult> verdicts;
};

Judged run(const std::string& scene, std::span<const Override> overrides = {}) {
    BuiltScene built = build_scene(parse_scene(scene, "test.toml", overrides));
    Judged judged{run_scene(built), {}};
    judged.verdicts = judge_run(built.scene.expectations, judged.result.measures, judged.result.timed, built.scene);
    return judged;
}

constexpr double g = 9.81, dt = 0.01;

/// Symplectic Euler: v_k = -g k dt, y_k = 2 - g dt^2 k (k + 1) / 2.
double height(int k) { return 2.0 - g * dt * dt * k * (k + 1) / 2; }

}  // namespace

TEST_CASE("what is expected at a time is measured in the first state at that time or after it") {
    const Judged judged = run(falling_sheet() +
                              "[[expect]]\nat = 0.05\nspeed_at_end = { below = 1.0 }\nlowest_vertex = { below = 0.0 }\n"
                              "[[expect]]\nat = 0.051\nlowest_vertex = { above = 0.0 }\n[[expect]]\nat = 0\nlowest_vertex = 2.0\n"
                              "[[expect]]\nlowest_vertex = { above = 0.0 }\n");
    REQUIRE(judged.verdicts.size() == 5);
    CHECK(*judged.verdicts[0].value == Approx(g * 0.05));
    CHECK(*judged.verdicts[1].value == Approx(height(5)));
    CHECK_FALSE(judged.verdicts[1].passed);
    CHECK(*judged.verdicts[2].value == Approx(height(6)));
    CHECK(*judged.verdicts[3].value == 2.0);
    CHECK(*judged.verdicts[4].value == Approx(height(10)));
    CHECK(judged.verdicts[0].text == "speed_at_end at 0.05 s 0.4905, expected < 1: passed");
}

TEST_CASE("what a run has at its end must hold in every state of an interval, and the value is the farthest from it") {
    const Judged judged = run(falling_sheet() +
                              "[[expect]]\nduring = [0.02, 0.06]\nspeed_at_end = { between = [0.1, 0.5] }\n"
                              "lowest_vertex = { above = 1.985 }\n"
                              "[[expect]]\nduring = [0.02, 0.06]\nspeed_at_end = { above = 0.1 }\n"
                              "[[expect]]\nduring = [0.021, 0.029]\nspeed_at_end = { above = 0.1 }\n");
    REQUIRE(judged.verdicts.size() == 4);
    CHECK(*judged.verdicts[0].value == Approx(g * 0.06));
    CHECK_FALSE(judged.verdicts[0].passed);
    CHECK(*judged.verdicts[1].value == Approx(height(6)));
    CHECK_FALSE(judged.verdicts[1].passed);
    CHECK(*judged.verdicts[2].value == Approx(g * 0.02));
    CHECK(judged.verdicts[2].passed);
    CHECK(judged.verdicts[3].text == "speed_at_end during 0.021 ... 0.029 s not measured, expected > 0.1: failed");
}

TEST_CASE("a time that the run does not reach was not measured, which has failed") {
    const Judged judged = run(falling_sheet() + "[[expect]]\nat = 0.5\nlowest_vertex = { below = 9.0 }\n");
    CHECK_FALSE(judged.verdicts.at(0).value.has_value());
    CHECK_FALSE(judged.verdicts.at(0).passed);
}

TEST_CASE("the widest gap of seams is measured at the end, at a time and in every state of an interval, and not without a seam") {
    const std::string sheets =
        "duration = 0.2\n[step]\ntime_step = 0.01\n[fabric.f]\nsprings = { structural = 100.0 }\n"
        "[[cloth]]\nname = \"a\"\nfabric = \"f\"\ngrid = { size = [1, 1], vertices = [2, 2] }\n"
        "[[cloth]]\nname = \"b\"\nfabric = \"f\"\ngrid = { size = [1, 1], vertices = [2, 2] }\n"
        "pose = { translation = [0, 0.1, 0] }\n";
    const std::string seam = "[[seam]]\ncloths = [\"a\", \"b\"]\nvertices = [[0, 0], [1, 1]]\nduration = 0.1\nstiffness = 1e4\n";
    const std::string expected =
        "[[expect]]\nlargest_seam_gap = { below = 0.01 }\n[[expect]]\nat = 0.05\nlargest_seam_gap = { between = [0.04, 0.06] }\n"
        "[[expect]]\nduring = [0.0, 0.2]\nlargest_seam_gap = { below = 0.05 }\n";
    const Judged judged = run(sheets + seam + expected);
    CHECK(judged.verdicts.at(0).passed);
    CHECK(judged.verdicts.at(0).value == judged.result.measures.largest_seam_gap);
    CHECK(judged.verdicts.at(1).passed);
    // The gap is widest at the start.
    CHECK_FALSE(judged.verdicts.at(2).passed);
    CHECK(*judged.verdicts.at(2).value == Approx(0.1).epsilon(0.02));
    for (const ExpectationResult& verdict : run(sheets + expected).verdicts) {
        CHECK_FALSE(verdict.passed);
        CHECK_FALSE(verdict.value.has_value());
    }
}

TEST_CASE("over an interval that is the whole run sums and extremes are those of the run") {
    const std::string measures =
        "intersections = 0\ndeepest_penetration = { below = 1.0 }\nsmallest_distance = { above = 0.0 }\n"
        "largest_strain = { below = 1.0 }\nenergy_gain = { below = 1.0 }\n";
    const Judged judged = run(sheet_on_box() + "[[expect]]\n" + measures + "[[expect]]\nduring = [0.0, 10.0]\n" + measures);
    REQUIRE(judged.verdicts.size() == 10);
    for (std::size_t i = 0; i < 5; ++i) {
        CAPTURE(judged.verdicts[i].text, judged.verdicts[i + 5].text);
        REQUIRE(judged.verdicts[i].value.has_value());
        REQUIRE(judged.verdicts[i + 5].value.has_value());
        CHECK(*judged.verdicts[i].value == Approx(*judged.verdicts[i + 5].value).epsilon(1e-12));
    }
}

TEST_CASE("an interval holds only what happens within it: before the sheet meets the box nothing is near") {
    const Judged judged = run(sheet_on_box() +
                              "[[expect]]\nduring = [0.0, 0.02]\nsmallest_distance = { above = 0.005 }\n"
                              "[[expect]]\nat = 0.2\nsmallest_distance = { below = 0.006 }\n");
    for (const ExpectationResult& verdict : judged.verdicts) {
        CAPTURE(verdict.text);
        CHECK(verdict.passed);
    }
}

TEST_CASE("adaptive steps end where an expectation has its time") {
    const Judged judged = run(falling_sheet() + "[[expect]]\nat = 0.0437\nspeed_at_end = { below = 1.0 }\n",
                              std::vector<Override>{{"step.time_step", "auto"}, {"step.scheme", "backward_euler"}});
    CHECK(*judged.verdicts.at(0).value == Approx(g * 0.0437).epsilon(1e-9));
}

TEST_CASE("what was measured goes along with a checkpoint, and a time that is over is not measured again") {
    const std::string scene = falling_sheet() +
                              "[[expect]]\nat = 0.02\nlowest_vertex = { above = 0.0 }\n"
                              "[[expect]]\nduring = [0.02, 0.08]\nspeed_at_end = { below = 0.1 }\n";
    const Judged whole = run(scene);
    BuiltScene first = build_scene(parse_scene(scene, "test.toml")), second = build_scene(parse_scene(scene, "test.toml"));
    RunState state;
    RunHooks hooks;
    hooks.checkpoint = [&](const RunState& now) {
        if (now.steps_made == 5) state = now;
    };
    run_scene(first, hooks, {.checkpoint_every = 0.01});
    REQUIRE(state.steps_made == 5);
    const RunResult resumed = run_scene(second, {}, {.from = &state});
    CHECK(resumed.timed == whole.result.timed);
    state.timed.clear();
    BuiltScene third = build_scene(parse_scene(scene, "test.toml"));
    CHECK_THROWS_WITH(run_scene(third, {}, {.from = &state}), Catch::Contains("what was expected of it"));
}

TEST_CASE("a strain that is too large is reported with its cloth and its time") {
    const auto sheet = [](const std::string& name, const std::string& density) {
        return "[fabric." + name + "]\narea_density = " + density + "\nsprings = { structural = 100 }\n[[cloth]]\nname = \"" +
               name + "\"\nfabric = \"" + name + "\"\ngrid = { size = [0.2, 0.2], vertices = [3, 3] }\npin = [0]\n";
    };
    const Judged judged = run("duration = 0.1\n[step]\ntime_step = 0.01\n" + sheet("light", "0.1") + sheet("heavy", "1.0") +
                              "[[expect]]\nlargest_strain = { below = 1e-6 }\n[[expect]]\nlargest_strain = { below = 1.0 }\n");
    REQUIRE(judged.verdicts.size() == 2);
    CHECK(judged.result.measures.strained_cloth == 1);
    CHECK(judged.verdicts[0].text.find(": failed (cloth 'heavy' at 0.") != std::string::npos);
    CHECK(judged.verdicts[1].text.ends_with(": passed"));
}

}  // namespace percale::scenes::test::timed_measures_test
