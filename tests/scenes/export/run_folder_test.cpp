#include "export/run_folder.h"

#include <algorithm>

#include "format/scene_file.h"
#include "frames/obj_frames.h"
#include "percale/error.h"
#include "run/scene_plan.h"
#include "tests/scenes/frames/tally_frames.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::run_folder_test {
namespace {

void run_into(const std::string& path, const std::vector<Override>& overrides = {}, bool with_state_hash = false) {
    BuiltScene built = build_scene(parse_scene(falling_sheet(), "test.toml", overrides));
    RunFolder folder(path, built.scene, with_state_hash);
    RunHooks hooks;
    hooks.begin = [&] { folder.begin(); };
    hooks.frame = [&](const Frame& frame) { folder.add(frame); };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) { folder.add(report, simulation); };
    const RunResult result = run_scene(built, hooks);
    folder.finish(built, result, {});
}

}  // namespace

TEST_CASE("a run leaves its frames, its steps and its report, and no more") {
    const TestFolder folder;
    run_into(folder.path("a/b"));
    CHECK(folder.holds("a/b/report.json"));
    CHECK(folder.holds("a/b/steps.csv"));
    CHECK(folder.holds("a/b/frames/sheet_00000.obj"));
    CHECK(folder.holds("a/b/frames/sheet_00005.obj"));
    CHECK(folder.file_count() == 8);
    CHECK(read_frame_records(folder.path("a/b")).size() == 6);
}

TEST_CASE("without frames on disk the report still lists what was certified") {
    const TestFolder folder;
    run_into(folder.path(), {{"output.frames", "none"}});
    CHECK(folder.file_count() == 2);
    const std::vector<FrameRecord> frames = read_frame_records(folder.path());
    REQUIRE(frames.size() == 6);
    CHECK(frames[5].cloths.empty());
}

TEST_CASE("state hashes are in the steps only when asked for") {
    const TestFolder folder;
    run_into(folder.path("plain"));
    run_into(folder.path("hashed"), {}, true);
    const std::string plain = folder.read("plain/steps.csv"), hashed = folder.read("hashed/steps.csv");
    CHECK(plain.substr(plain.size() - 2) == ",\n");
    CHECK(hashed.size() == plain.size() + 10 * 16);
}

TEST_CASE("a shorter run into the same folder leaves no frame of the longer one, and nothing else is touched") {
    const TestFolder folder;
    run_into(folder.path());
    folder.write("frames/mine.obj", "mine");
    folder.write("notes.txt", "mine");
    run_into(folder.path(), {{"duration", "0.04"}});
    CHECK(folder.holds("frames/sheet_00002.obj"));
    CHECK_FALSE(folder.holds("frames/sheet_00003.obj"));
    CHECK(folder.read("frames/mine.obj") == "mine");
    CHECK(folder.file_count() == 7);
}

TEST_CASE("from the beginning to the end of a run there is no report") {
    const TestFolder folder;
    run_into(folder.path());
    const BuiltScene built = build_scene(parse_scene(falling_sheet(), "test.toml"));
    {
        RunFolder second(folder.path(), built.scene, false);
        CHECK(folder.holds("report.json"));
        second.begin();
        CHECK_FALSE(folder.holds("report.json"));
        CHECK_FALSE(folder.holds("steps.csv"));
    }
    CHECK(folder.file_count() == 0);
}

TEST_CASE("a report that lists files elsewhere does not get them removed") {
    const TestFolder folder;
    folder.write("precious.obj", "mine");
    std::filesystem::create_directories(folder.path("out/frames"));
    folder.write("out/keep.obj", "mine");
    folder.write("out/report.json",
                 R"({"frames": [{"index": 0, "time": 0, "intersections": 0, "deepest_penetration": 0, "smallest_distance": null,)"
                 R"( "cloths": ["../precious.obj", "keep.obj", "frames/../keep.obj", "/etc/x.obj"], "obstacles": []}]})");
    run_into(folder.path("out"));
    CHECK(folder.holds("precious.obj"));
    CHECK(folder.holds("out/keep.obj"));
}

TEST_CASE("a folder that holds another report, or is a file, is refused and left alone") {
    const TestFolder folder;
    folder.write("report.json", "not ours");
    CHECK_THROWS_WITH(run_into(folder.path()), Catch::Contains("-o"));
    CHECK(folder.read("report.json") == "not ours");
    CHECK(folder.file_count() == 1);
    CHECK_THROWS_AS(run_into(folder.path("report.json")), SceneError);
}

namespace {

/// The first steps of a run, left where a checkpoint was made after `kept` of them.
FolderState leave_run(const std::string& path, int kept) {
    BuiltScene built = build_scene(parse_scene(falling_sheet(), "test.toml"));
    RunFolder folder(path, built.scene, false);
    FolderState state;
    int steps = 0;
    RunHooks hooks;
    hooks.begin = [&] { folder.begin(); };
    hooks.frame = [&](const Frame& frame) {
        folder.add(frame);
        if (steps != kept) return;
        state = folder.state();
        folder.keep();
    };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) {
        folder.add(report, simulation);
        ++steps;
    };
    run_scene(built, hooks);
    return state;
}

}  // namespace

TEST_CASE("a run that fails after a checkpoint leaves just what that needs") {
    const TestFolder folder;
    const FolderState state = leave_run(folder.path(), 4);
    REQUIRE(state.frames.size() == 3);
    CHECK(folder.holds("frames/sheet_00002.obj"));
    CHECK_FALSE(folder.holds("frames/sheet_00003.obj"));
    CHECK(folder.holds("steps.csv.part"));
    CHECK(folder.file_count() == 4);
}

TEST_CASE("a folder goes on from what another run left, here or elsewhere, and not where something is missing") {
    for (const std::string name : {"left", "new"}) {
        const TestFolder folder;
        const FolderState state = leave_run(folder.path("left"), 4);
        const BuiltScene built = build_scene(parse_scene(falling_sheet(), "test.toml"));
        folder.write("left/frames/sheet_00004.obj.part", "half");
        folder.write("left/checkpoint.percale.part", "half");
        {
            RunFolder resumed(folder.path(name), built.scene, false);
            resumed.begin_from(state, folder.path("left"));
            CHECK(resumed.state().step_bytes == state.step_bytes);
            CHECK(resumed.state().frames.size() == 3);
            CHECK(folder.holds(name + "/frames/sheet_00002.obj"));
            CHECK(std::filesystem::file_size(folder.path(name + "/steps.csv.part")) == state.step_bytes);
            CHECK(folder.holds("left/frames/sheet_00004.obj.part") == (name == "new"));
            CHECK(folder.holds("left/checkpoint.percale.part") == (name == "new"));
        }
        CHECK(folder.holds("left/steps.csv.part"));
        CHECK(folder.holds("left/frames/sheet_00002.obj"));
        CHECK_FALSE(folder.holds("new/frames/sheet_00002.obj"));
        CHECK_FALSE(folder.holds("new/steps.csv.part"));
        std::filesystem::remove(folder.path("left/frames/sheet_00001.obj"));
        RunFolder again(folder.path(name), built.scene, false);
        CHECK_THROWS_WITH(again.begin_from(state, folder.path("left")), Catch::Contains("frames/sheet_00001.obj"));
    }
}

TEST_CASE("a state that lists files elsewhere is refused") {
    const TestFolder folder;
    FolderState state = leave_run(folder.path("left"), 4);
    state.frames[0].cloths[0] = "../precious.obj";
    const BuiltScene built = build_scene(parse_scene(falling_sheet(), "test.toml"));
    RunFolder resumed(folder.path("new"), built.scene, false);
    CHECK_THROWS_WITH(resumed.begin_from(state, folder.path("left")), Catch::Contains("is no frame of a run"));
}

namespace {

const std::vector<FrameFormat>& two_formats() {
    static const std::vector<FrameFormat> formats = {obj_frames(), tally_frames()};
    return formats;
}

struct Left {
    RunState run;
    FolderState folder;
};

/// A run with a format for the whole run, from its start or from where another one was left in the folder `other`. Until 0.04 s
/// and then killed where `left` is given.
void run_tally(const std::string& path, Left* left = nullptr, const Left* from = nullptr, const std::string& other = "",
               const std::vector<std::string>& words = {"tally"}) {
    BuiltScene built = build_scene(parse_scene(falling_sheet(), "test.toml"));
    built.scene.output.frames = words;
    const std::span<const FrameFormat> formats = words.size() > 1 ? frame_formats() : two_formats();
    RunFolder folder(path, built.scene, false, formats);
    RunHooks hooks;
    hooks.begin = [&] { from ? folder.begin_from(from->folder, other) : folder.begin(); };
    hooks.frame = [&](const Frame& frame) { folder.add(frame); };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) { folder.add(report, simulation); };
    if (left) {
        hooks.checkpoint = [&](const RunState& state) {
            if (left->run.steps_made > 0) return;
            *left = {state, folder.state()};
            folder.keep();
        };
    }
    const RunResult result =
        run_scene(built, hooks, {.checkpoint_every = left ? 0.04 : 0.0, .from = from ? &from->run : nullptr});
    if (!left) folder.finish(built, result, {});
}

void run_obj(const std::string& path) {
    const BuiltScene built = build_scene(parse_scene(falling_sheet(), "test.toml"));
    RunFolder folder(path, built.scene, false, two_formats());
    folder.begin();
    folder.add(Frame{.index = 0, .time = 0.0, .cloths = built.cloth_meshes, .obstacles = {}, .check = {}});
    folder.finish(built, {}, {});
}

}  // namespace

TEST_CASE("a format may have one file for all frames, which is whole at the end of the run") {
    const TestFolder folder;
    run_tally(folder.path());
    const std::string tally = folder.read(tally_file);
    CHECK(tally.starts_with("00006\n0 0 "));
    CHECK(std::count(tally.begin(), tally.end(), '\n') == 7);
    CHECK(folder.file_count() == 3);
    for (const FrameRecord& frame : read_frame_records(folder.path()))
        CHECK(frame.cloths == std::vector<std::string>{tally_file});
}

TEST_CASE("a run with one file for all frames that is gone on with ends with the same bytes, here or elsewhere") {
    const TestFolder folder;
    run_tally(folder.path("plain"));
    for (const std::string name : {"new", "left"}) {
        Left left;
        run_tally(folder.path("left"), &left);
        REQUIRE(left.folder.frames.size() == 3);
        REQUIRE(left.folder.grown.size() == 1);
        CHECK(std::filesystem::file_size(folder.path(std::string("left/") + tally_file + ".part")) > left.folder.grown[0].bytes);
        run_tally(folder.path(name), nullptr, &left, folder.path("left"));
        CHECK(folder.read(name + "/" + tally_file) == folder.read(std::string("plain/") + tally_file));
        CHECK(folder.read(name + "/steps.csv") == folder.read("plain/steps.csv"));
        CHECK(folder.holds(std::string("left/") + tally_file + ".part") == (name == "new"));
        // The same holds for a run that was finished since the checkpoint.
        run_tally(folder.path("again"), nullptr, &left, folder.path(name));
        CHECK(folder.read(std::string("again/") + tally_file) == folder.read(std::string("plain/") + tally_file));
    }
}

TEST_CASE("a run in all formats that is gone on with ends with the same bytes, here or elsewhere, also after it was finished") {
    const TestFolder folder;
    const std::vector<std::string> all = {"obj", "ply", "glb", "pc2", "mdd", "vtp"};
    run_tally(folder.path("plain"), nullptr, nullptr, "", all);
    const std::vector<std::string> kept = {"frames/scene.glb",      "frames/sheet.pc2",      "frames/sheet.mdd",
                                           "frames/scene.pvd",      "frames/sheet.mesh.obj", "frames/sheet_00004.vtp",
                                           "frames/sheet_00001.ply"};
    for (const std::string name : {"new", "left"}) {
        Left left;
        run_tally(folder.path("left"), &left, nullptr, "", all);
        CHECK(left.folder.grown.size() == 3);
        const auto go_on = [&](const std::string& to) {
            run_tally(folder.path(to), nullptr, &left, folder.path("left"), all);
            for (const std::string& file : kept) {
                CAPTURE(to, file);
                CHECK(folder.read(to + "/" + file) == folder.read("plain/" + file));
            }
        };
        go_on(name);
        go_on("again");
        if (name == "left") CHECK_FALSE(folder.holds("left/frames/scene.glb.samples"));
    }
    run_tally(folder.path("left"), nullptr, nullptr, "", {"obj", "ply"});
    CHECK_FALSE(folder.holds("left/frames/scene.glb"));
    CHECK_FALSE(folder.holds("left/frames/sheet.mesh.obj"));
}

TEST_CASE("the plan predicts to a third how much the frames of a run take, format by format") {
    const std::vector<Override> fine = {{"cloth.0.grid.vertices", "[40, 40]"}};
    for (const FrameFormat& format : frame_formats()) {
        CAPTURE(format.word);
        const TestFolder folder;
        BuiltScene built = build_scene(parse_scene(falling_sheet(), "test.toml", fine));
        built.scene.output.frames = {format.word};
        const OutputSize predicted = output_size_of(built);
        RunFolder run(folder.path(), built.scene, false);
        RunHooks hooks;
        hooks.begin = [&] { run.begin(); };
        hooks.frame = [&](const Frame& frame) { run.add(frame); };
        hooks.step = [&](const StepReport& report, const Simulation& simulation) { run.add(report, simulation); };
        run.finish(built, run_scene(built, hooks), {});
        CHECK(predicted.frames == static_cast<double>(read_frame_records(folder.path()).size()));
        double bytes = 0.0;
        for (const auto& entry : std::filesystem::directory_iterator(folder.path("frames")))
            bytes += static_cast<double>(entry.file_size());
        CHECK(predicted.bytes == Approx(bytes).epsilon(0.34));
    }
}

TEST_CASE("a state that lists a grown file elsewhere is refused") {
    const TestFolder folder;
    Left left;
    run_tally(folder.path("left"), &left);
    left.folder.grown[0].name = "../all.tally";
    CHECK_THROWS_WITH(run_tally(folder.path("new"), nullptr, &left, folder.path("left")),
                      Catch::Contains("is no frame of a run"));
}

TEST_CASE("a run in another format leaves nothing of the one before, finished or killed") {
    const TestFolder folder;
    run_tally(folder.path());
    run_obj(folder.path());
    CHECK_FALSE(folder.holds(tally_file));
    CHECK(folder.holds("frames/sheet_00000.obj"));
    run_tally(folder.path());
    CHECK_FALSE(folder.holds("frames/sheet_00000.obj"));
    CHECK(folder.file_count() == 3);
    Left left;
    run_tally(folder.path(), &left);
    CHECK(folder.holds(std::string(tally_file) + ".part"));
    run_obj(folder.path());
    CHECK_FALSE(folder.holds(std::string(tally_file) + ".part"));
    CHECK(folder.file_count() == 3);
}

TEST_CASE("fields are refused where the frames hold none, and taken where they do or nothing is written") {
    const TestFolder folder;
    Scene scene = parse_scene(falling_sheet(), "test.toml");
    scene.output.fields = {"strain"};
    CHECK_THROWS_WITH(RunFolder(folder.path(), scene, false),
                      Catch::Contains("output.frames = \"obj\" holds no fields; with them it must be one of none, ply, vtp"));
    for (const char* word : {"ply", no_frames}) {
        scene.output.frames = {word};
        CHECK_NOTHROW(RunFolder(folder.path(), scene, false));
    }
}

TEST_CASE("a word that no format has is refused with those that there are") {
    const TestFolder folder;
    Scene scene = parse_scene(falling_sheet(), "test.toml");
    scene.output.frames = {"tally"};
    CHECK_THROWS_WITH(RunFolder(folder.path(), scene, false),
                      Catch::Contains("'tally'; valid: none, obj, ply, glb, pc2, mdd, vtp"));
    CHECK_NOTHROW(RunFolder(folder.path(), scene, false, two_formats()));
    CHECK(folder.file_count() == 0);
}

}  // namespace percale::scenes::test::run_folder_test
