#include <nlohmann/json.hpp>

#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::common_options_test {
using percale::scenes::test::falling_sheet;

namespace {

/// Runs the falling sheet with further options into `out`.
ProgramRun run_with(const TestFolder& folder, std::vector<std::string> options) {
    folder.write("sheet.toml", falling_sheet());
    std::vector<std::string> arguments = {"run", "sheet.toml", "-o", "out"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_program(arguments, folder.path());
}

}  // namespace

TEST_CASE("the option --set overrides keys, several times, without taking the words that follow") {
    const TestFolder folder;
    folder.write("sheet.toml", falling_sheet());
    const ProgramRun run =
        run_program({"run", "--set", "duration=0.04", "--set", "step.scheme=rk4", "sheet.toml", "-o", "out"}, folder.path());
    CHECK(run.exit_code == 0);
    const auto report = nlohmann::json::parse(folder.read("out/report.json"));
    CHECK(report.at("steps") == 4);
    CHECK(report.at("settings").at("step").at("scheme") == "rk4");
    CHECK(report.at("settings").at("duration") == 0.04);
}

TEST_CASE("the option --fps and --frames win over the scene") {
    const TestFolder folder;
    CHECK(run_with(folder, {"--fps", "20", "--frames", "none"}).exit_code == 0);
    CHECK_FALSE(folder.holds("out/frames"));
    CHECK(nlohmann::json::parse(folder.read("out/report.json")).at("frames").size() == 3);
    CHECK(run_with(folder, {"--frames", "obj"}).exit_code == 0);
    CHECK(folder.holds("out/frames/sheet_00005.obj"));
}

TEST_CASE("wrong common options are refused, and nothing is written") {
    const TestFolder folder;
    CHECK(refused(run_with(folder, {"--set", "duration"}), "KEY=VALUE"));
    CHECK(refused(run_with(folder, {"--set", "=3"}), "KEY=VALUE"));
    CHECK(refused(run_with(folder, {"--set", "duratoin=3"}), "duration"));
    CHECK(refused(run_with(folder, {"--set", "duration=-3"}), "duration"));
    CHECK(refused(run_with(folder, {"--threads", "65"}),
                  "percale: --threads: step.threads = 65 is out of range; allowed: 1 ... 64"));
    CHECK(refused(run_with(folder, {"--threads", "0"}), "1 ... 64"));
    CHECK(refused(run_with(folder, {"--threads", "two"}), "threads"));
    CHECK(refused(run_with(folder, {"--fps", "0"}), "percale: --fps: output.fps = 0 1/s is out of range"));
    CHECK(refused(run_with(folder, {"--fps", "fast"}), "fps"));
    CHECK(refused(run_with(folder, {"--frames", "alembic"}),
                  "percale: --frames: output.frames has no choice 'alembic'; valid: none, obj, ply, glb, pc2, mdd, vtp"));
    CHECK(refused(run_with(folder, {"--frames", "objj"}), "did you mean 'obj'?"));
    CHECK_FALSE(folder.holds("out"));
    CHECK(run_with(folder, {"--threads", "2"}).exit_code == 0);
    CHECK(nlohmann::json::parse(folder.read("out/report.json")).at("settings").at("step").at("threads") == 2);
}

TEST_CASE("the option --quiet leaves both channels empty when all is well") {
    const TestFolder folder;
    const ProgramRun run = run_with(folder, {"--quiet"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.empty());
    CHECK(run.error.empty());
}

}  // namespace percale::program::test::common_options_test
