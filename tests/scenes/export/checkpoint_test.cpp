#include "export/checkpoint.h"

#include "export/run_settings.h"
#include "format/scene_file.h"
#include "percale/error.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::checkpoint_test {
namespace {

Scene scene_with(std::vector<Override> overrides = {}) {
    overrides.insert(overrides.begin(), {"step.measure", "ledger"});
    return parse_scene(sheet_on_box(), "test.toml", overrides);
}

Checkpoint example() {
    Checkpoint checkpoint;
    BuiltScene built = build_scene(scene_with());
    RunHooks hooks;
    hooks.checkpoint = [&](const RunState& state) { checkpoint.run = state; };
    run_scene(built, hooks, {.certify_steps = true, .checkpoint_every = 0.05});
    checkpoint.run.totals.pinches = {{.obstacles = {0, 1}, .from = 0.5, .to = 0.75, .yielded = 0.01}};
    checkpoint.settings = settings_text(built.scene);
    checkpoint.certify_steps = true;
    checkpoint.folder.step_bytes = 1234;
    checkpoint.folder.frames = {{0, 0.0, {"frames/sheet_00000.obj"}, {}, {}, {}, {}},
                                {1, 0.5, {"a", "b"}, {"c"}, {"d"}, {}, {{0, 1}}}};
    return checkpoint;
}

std::string refusal(const Checkpoint& checkpoint, const std::vector<Override>& overrides, bool certify = true,
                    bool hashes = false) {
    try {
        check_same_run("a.percale", checkpoint, scene_with(overrides), certify, hashes);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a checkpoint comes back from its file as it was") {
    const TestFolder folder;
    const Checkpoint written = example();
    write_checkpoint(folder.path("a.percale"), written);
    CHECK(folder.file_count() == 1);
    const Checkpoint read = read_checkpoint(folder.path("a.percale"));
    CHECK(read.settings == written.settings);
    CHECK(read.run.simulation == written.run.simulation);
    CHECK(read.run.steps_made == written.run.steps_made);
    CHECK(read.run.totals.energy.total() == written.run.totals.energy.total());
    REQUIRE(read.run.totals.pinches.size() == 1);
    CHECK(read.run.totals.pinches[0].obstacles == std::array{0, 1});
    CHECK(read.run.totals.pinches[0].yielded == 0.01);
    REQUIRE(read.run.measures.steps.has_value());
    CHECK(read.run.measures.steps->states == written.run.measures.steps->states);
    REQUIRE(read.folder.frames.size() == 2);
    CHECK(read.folder.frames[1].cloths == written.folder.frames[1].cloths);
    CHECK(read.folder.frames[1].meeting == written.folder.frames[1].meeting);
    CHECK(read.folder.step_bytes == 1234);
    write_checkpoint(folder.path("b.percale"), read);
    CHECK(folder.read("a.percale") == folder.read("b.percale"));
}

TEST_CASE("a file that is no checkpoint, cut off or damaged is refused by name") {
    const TestFolder folder;
    const std::string file = folder.path("a.percale");
    CHECK_THROWS_WITH(read_checkpoint(file), Catch::Contains(file) && Catch::Contains("No such file"));
    CHECK_THROWS_WITH(read_checkpoint(folder.path()), Catch::Contains("cannot be read"));
    for (const std::string text : {"", "x", "title = \"no checkpoint but a scene, and a long one\""}) {
        folder.write("a.percale", text);
        CHECK_THROWS_WITH(read_checkpoint(file), Catch::StartsWith(file + ": checkpoint: it is "));
    }
    write_checkpoint(file, example());
    const std::string good = folder.read("a.percale");
    for (std::size_t at = 0; at < good.size(); at += 397) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ 1);
        folder.write("a.percale", bad);
        CHECK_THROWS_AS(read_checkpoint(file), SceneError);
        folder.write("a.percale", good.substr(0, at));
        CHECK_THROWS_AS(read_checkpoint(file), SceneError);
    }
}

TEST_CASE("a checkpoint of another run is refused with the settings that differ, threads may") {
    const Checkpoint checkpoint = example();
    CHECK(refusal(checkpoint, {}).empty());
    CHECK(refusal(checkpoint, {{"step.threads", "2"}}).empty());
    CHECK(refusal(checkpoint, {{"step.time_step", "0.01"}}) ==
          "a.percale: is of another run and cannot be resumed: step.time_step is 0.01, in the checkpoint 0.016666666666666666");
    CHECK(refusal(checkpoint, {{"fabric.sheet.friction", "0.5"}, {"duration", "9"}}).find("duration is 9.0, in the") !=
          std::string::npos);
    CHECK(refusal(checkpoint, {{"cloth.sheet.pin", "[3]"}}).find("cloth.0.pin") != std::string::npos);
    CHECK(refusal(checkpoint, {}, false).find("it was made with --certify-steps") != std::string::npos);
    CHECK(refusal(checkpoint, {}, true, true).find("it was made without --replay-hash") != std::string::npos);
}

}  // namespace percale::scenes::test::checkpoint_test
