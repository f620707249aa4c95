#include "export/kept_run.h"

#include <cmath>
#include <filesystem>

#include "format/scene_file.h"
#include "percale/error.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::kept_run_test {
namespace {

const std::string with_meshes = R"(
[[obstacle]]
name = "still"
mesh = "still.obj"
[[obstacle]]
name = "walker"
mesh = "walk_%02d.obj"
frames = [3, 5]
)";

constexpr const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";

/// A scene that names a mesh and three frames.
Scene scene_in(const TestFolder& folder) {
    for (const char* name : {"still.obj", "walk_03.obj", "walk_04.obj", "walk_05.obj", "walk_06.obj"})
        folder.write(name, triangle);
    return load_scene(folder.write("scene.toml", falling_sheet() + with_meshes));
}

RunResult run(KeptRun& kept, const Scene& scene, const std::function<bool()>& stop_asked = {}) {
    BuiltScene built = build_scene(scene);
    RunHooks stops;
    stops.stop_asked = stop_asked;
    return kept.run(built, stops, scene.expectations);
}

/// Leaves the folder as a run that is interrupted in its fourth step does.
void begin_run(const std::string& into, const Scene& scene) {
    KeptRun kept(into, scene, {}, "1");
    int steps = 0;
    CHECK(run(kept, scene, [&] { return ++steps == 4; }).status == RunStatus::stopped);
}

Scene plain_scene(const TestFolder& folder) {
    return load_scene(folder.write("plain.toml", falling_sheet() + "[expect]\nspeed_at_end = { below = 2.0 }\n"));
}

}  // namespace

TEST_CASE("an origin changes with every file that a scene names, and with no other") {
    const TestFolder folder;
    const Scene scene = scene_in(folder);
    const std::string before = run_origin(scene, {}, "1");
    CHECK(changed_origin(run_origin(scene, {}, "1"), before).empty());
    folder.write("walk_06.obj", "nothing");
    CHECK(changed_origin(run_origin(scene, {}, "1"), before).empty());
    folder.write("still.obj", std::string(triangle) + "# a comment\n");
    CHECK(changed_origin(run_origin(scene, {}, "1"), before) == "still.obj has changed");
    folder.write("still.obj", triangle);
    folder.write("walk_04.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1.5\nf 1 2 3\n");
    CHECK(changed_origin(run_origin(scene, {}, "1"), before) == "walk_04.obj has changed");
    folder.write("walk_04.obj", triangle);
    std::filesystem::remove(folder.path("walk_05.obj"));
    CHECK(changed_origin(run_origin(scene, {}, "1"), before) == "walk_05.obj has changed");
}

TEST_CASE("an origin says which program, option, setting or line of the scene file is another") {
    const TestFolder folder;
    const Scene scene = scene_in(folder);
    const std::string before = run_origin(scene, {}, "1");
    CHECK(changed_origin(run_origin(scene, {}, "2"), before) == "it was made by another program");
    CHECK(changed_origin(run_origin(scene, {.certify_steps = true}, "1"), before) == "it was made without --certify-steps");
    CHECK(changed_origin(before, run_origin(scene, {.certify_steps = false, .replay_hash = true}, "1")) ==
          "it was made with --replay-hash");
    Scene other = scene;
    other.step.threads = 2;
    CHECK(changed_origin(run_origin(other, {}, "1"), before).empty());
    other.duration = 0.5;
    CHECK(changed_origin(run_origin(other, {}, "1"), before) == "duration is 0.5, was 0.1");
    folder.write("scene.toml", folder.read("scene.toml") + "# a comment\n");
    CHECK(changed_origin(run_origin(scene, {}, "1"), before) == "scene.toml has changed");
    CHECK(changed_origin(before, before.substr(0, before.size() / 2)) == "origin.json is damaged");
    CHECK(changed_origin(before, "{}") == "origin.json is damaged");
}

TEST_CASE("an origin is the same in another folder with the same files") {
    const TestFolder here, there;
    CHECK(run_origin(scene_in(here), {}, "1") == run_origin(scene_in(there), {}, "1"));
}

TEST_CASE("an origin changes with every part of an expectation") {
    const TestFolder folder;
    const Scene scene = plain_scene(folder);
    const std::string before = run_origin(scene, {}, "1");
    const auto change = [&](const std::function<void(Expectation&)>& edit) {
        Scene other = scene;
        edit(other.expectations.at(0));
        return changed_origin(run_origin(other, {}, "1"), before);
    };
    const std::string changed = "expectations have changed";
    CHECK(change([](Expectation&) {}).empty());
    CHECK(change([](Expectation& one) { one.measure = "rms_speed_at_end"; }) == changed);
    CHECK(change([](Expectation& one) { one.highest = std::nextafter(one.highest, 3.0); }) == changed);
    CHECK(change([](Expectation& one) { one.highest_included = !one.highest_included; }) == changed);
    CHECK(change([](Expectation& one) { one.lowest = 0.0; }) == changed);
    CHECK(change([](Expectation& one) { one.lowest_included = !one.lowest_included; }) == changed);
    CHECK(change([](Expectation& one) { one.at = 0.1; }) == changed);
    CHECK(change([](Expectation& one) { one.during = {0.0, 0.1}; }) == changed);
    CHECK(change([](Expectation& one) { one.file = "other.obj"; }) == changed);
    Scene none = scene;
    none.expectations.clear();
    CHECK(changed_origin(run_origin(none, {}, "1"), before) == changed);
}

TEST_CASE("a file that cannot be looked at is named") {
    const TestFolder folder;
    Scene scene = scene_in(folder);
    scene.obstacles.at(0).mesh = std::string(300, 'a').append(".obj");
    CHECK_THROWS_AS(run_origin(scene, {}, "1"), SceneError);
    CHECK_THROWS_WITH(run_origin(scene, {}, "1"), Catch::Contains("aaa.obj: cannot be read: "));
    CHECK_THROWS_AS(KeptRun(folder.path(std::string(300, 'b')), plain_scene(folder), {}, "1"), SceneError);
}

TEST_CASE("a report says how a run ended, or that it did not") {
    const TestFolder folder;
    CHECK_FALSE(ended_run(folder.path()).has_value());
    folder.write("report.json", "{\"status\": \"stopped\", \"steps\": 3}");
    CHECK_FALSE(ended_run(folder.path()).has_value());
    folder.write("report.json", "{\"status\": \"fini");
    CHECK_FALSE(ended_run(folder.path()).has_value());
    folder.write("report.json",
                 "{\"status\": \"failed\", \"reason\": \"torn\", \"steps\": 3, \"simulated_s\": 0.5, "
                 "\"expectations\": [{\"passed\": true, \"text\": \"good\"}]}");
    const std::optional<EndedRun> run = ended_run(folder.path());
    REQUIRE(run.has_value());
    CHECK(run->status + run->reason == "failedtorn");
    CHECK(run->steps == 3);
    CHECK(run->simulated_s == 0.5);
    REQUIRE(run->expectations.size() == 1);
    CHECK(run->expectations[0].passed);
    CHECK(run->expectations[0].text == "good");
}

TEST_CASE("a run that was kept has ended for the same scene, and not for another") {
    const TestFolder folder;
    const Scene scene = plain_scene(folder);
    const std::string into = folder.path("kept");
    KeptRun first(into, scene, {.certify_steps = false, .replay_hash = true}, "1");
    CHECK_FALSE(first.ended().has_value());
    CHECK(first.why_again().empty());
    CHECK_FALSE(folder.holds("kept"));
    CHECK(run(first, scene).status == RunStatus::finished);
    CHECK_FALSE(folder.holds("kept/checkpoint.percale"));
    const KeptRun again(into, scene, {.certify_steps = false, .replay_hash = true}, "1");
    REQUIRE(again.ended().has_value());
    CHECK(again.ended()->steps == 10);
    REQUIRE(again.ended()->expectations.size() == 1);
    CHECK(again.ended()->expectations[0].text == "speed_at_end 0.981, expected < 2: passed");
    CHECK(again.state_hash().size() == 16);
    CHECK(folder.read("kept/steps.csv").find(again.state_hash()) != std::string::npos);
    const KeptRun other(into, scene, {.certify_steps = false, .replay_hash = true}, "2");
    CHECK_FALSE(other.ended().has_value());
    CHECK(other.why_again() == "it was made by another program");
}

TEST_CASE("a run that was stopped goes on where it stopped, and ends with the same table") {
    const TestFolder folder;
    const Scene scene = plain_scene(folder);
    const std::string into = folder.path("kept");
    KeptRun whole(folder.path("whole"), scene, {}, "1");
    run(whole, scene);
    begin_run(into, scene);
    KeptRun second(into, scene, {}, "1");
    CHECK_FALSE(second.ended().has_value());
    const RunResult result = run(second, scene);
    CHECK(result.status == RunStatus::finished);
    REQUIRE(result.resumed_at.size() == 1);
    CHECK(result.resumed_at[0] == Approx(0.04));
    CHECK(folder.read("kept/steps.csv") == folder.read("whole/steps.csv"));
    CHECK(folder.holds("kept/origin.json"));
    CHECK(KeptRun(into, scene, {}, "1").ended().has_value());
}

TEST_CASE("a checkpoint that is damaged is reported, and the run begins anew") {
    const TestFolder folder;
    const Scene scene = plain_scene(folder);
    const std::string into = folder.path("kept");
    begin_run(into, scene);
    std::string bytes = folder.read("kept/checkpoint.percale");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    folder.write("kept/checkpoint.percale", bytes);
    KeptRun second(into, scene, {}, "1");
    CHECK(second.why_again().find("it is damaged") != std::string::npos);
    const RunResult result = run(second, scene);
    CHECK(result.status == RunStatus::finished);
    CHECK(result.resumed_at.empty());
}

TEST_CASE("a folder that another run was made into is not taken for a kept one, and left as it is") {
    const TestFolder folder;
    const Scene scene = plain_scene(folder);
    const std::string into = folder.path("kept");
    KeptRun first(into, scene, {}, "1");
    run(first, scene);
    BuiltScene built = build_scene(scene);
    RunFolder other(into, scene, false);
    RunHooks hooks;
    hooks.begin = [&] { other.begin(); };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) { other.add(report, simulation); };
    other.finish(built, run_scene(built, hooks), {});
    CHECK_FALSE(folder.holds("kept/origin.json"));
    const std::string report = folder.read("kept/report.json");
    CHECK_THROWS_WITH(KeptRun(into, scene, {}, "1"), Catch::Contains("kept/report.json: is of a run that is not kept here"));
    CHECK(folder.read("kept/report.json") == report);
}

TEST_CASE("a run that another command goes on with is not taken for a kept one") {
    const TestFolder folder;
    const Scene scene = plain_scene(folder);
    const std::string into = folder.path("kept");
    begin_run(into, scene);
    REQUIRE(folder.holds("kept/origin.json"));
    const Checkpoint checkpoint = read_checkpoint(folder.path("kept/checkpoint.percale"));
    BuiltScene built = build_scene(scene);
    RunFolder other(into, scene, false);
    RunHooks hooks;
    hooks.begin = [&] { other.begin_from(checkpoint.folder, into); };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) { other.add(report, simulation); };
    other.finish(built, run_scene(built, hooks, {.from = &checkpoint.run, .from_file = "checkpoint"}), {});
    CHECK(folder.holds("kept/report.json"));
    CHECK_FALSE(folder.holds("kept/origin.json"));
    CHECK_THROWS_WITH(KeptRun(into, scene, {}, "1"), Catch::Contains("is of a run that is not kept here"));
}

TEST_CASE("a report with other expectations than the scene is not taken for its result") {
    const TestFolder folder;
    const Scene scene = plain_scene(folder);
    const std::string into = folder.path("kept");
    KeptRun first(into, scene, {}, "1");
    run(first, scene);
    folder.write("kept/report.json", "{\"status\": \"finished\", \"frames\": []}");
    KeptRun second(into, scene, {}, "1");
    CHECK_FALSE(second.ended().has_value());
    CHECK(second.why_again() == "report.json has other expectations");
    CHECK(run(second, scene).status == RunStatus::finished);
    CHECK(KeptRun(into, scene, {}, "1").ended().has_value());
}

TEST_CASE("a checkpoint that cannot be removed does not undo a run that has ended") {
    const TestFolder folder;
    // The cloth is at rest long before the first checkpoint is due.
    const std::vector<Override> until_rest = {{"duration", "rest"}, {"max_duration", "600"}};
    const Scene scene = load_scene(folder.write("box.toml", sheet_on_box()), until_rest);
    const std::string into = folder.path("kept");
    KeptRun kept(into, scene, {}, "1");
    const RunResult result = run(kept, scene, [&] {
        // fs::remove refuses a folder with something in it.
        std::filesystem::create_directories(folder.path("kept/checkpoint.percale/full"));
        return false;
    });
    CHECK(result.status == RunStatus::finished);
    CHECK(folder.holds("kept/checkpoint.percale"));
    CHECK(KeptRun(into, scene, {}, "1").ended().has_value());
}

TEST_CASE("a program is identified by its version and the checksum of its files") {
    const std::string first = program_checksum();
    CHECK(first.starts_with(PERCALE_VERSION " "));
    CHECK(first.size() == std::string(PERCALE_VERSION).size() + 17);
    CHECK(program_checksum() == first);
}

}  // namespace percale::scenes::test::kept_run_test
