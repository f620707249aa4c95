#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::doctor_test {
using namespace percale::scenes::test;

namespace {

const std::string lone_triangle = "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nf 1 3 2\n";
const std::string flat_triangle = "v 0 0 0\nv 0.1 0 0\nv 0.2 0 0\nf 1 3 2\n";

}  // namespace

TEST_CASE("doctor says that nothing was found, or what, and ends with 0 or 1") {
    const TestFolder folder;
    folder.write("sheet.toml", sheet_on_box());
    folder.write("flat.obj", flat_triangle);
    const ProgramRun well = run_program({"doctor", "sheet.toml"}, folder.path());
    CHECK(well.exit_code == 0);
    CHECK(well.out == "sheet.toml: nothing found\n");
    CHECK(well.error.empty());
    const ProgramRun sick = run_program({"doctor", "sheet.toml", "flat.obj"}, folder.path());
    CHECK(sick.exit_code == 1);
    CHECK(sick.out.find("sheet.toml: nothing found\nflat.obj: error: as cloth: ") == 0);
    CHECK(sick.error.empty());
    CHECK(folder.file_count() == 2);
}

TEST_CASE("warnings and notes alone leave exit code 0") {
    const TestFolder folder;
    folder.write("falling.toml", falling_sheet());
    folder.write("triangle.obj", lone_triangle);
    const ProgramRun run = run_program({"doctor", "falling.toml", "triangle.obj"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("falling.toml: 0 errors, 1 warning, 0 notes") != std::string::npos);
    CHECK(run.out.find("triangle.obj: 0 errors, 0 warnings, 1 note\n") != std::string::npos);
}

TEST_CASE("doctor takes --as, --set and --json") {
    const TestFolder folder;
    folder.write("falling.toml", falling_sheet());
    folder.write("triangle.obj", lone_triangle);
    CHECK(run_program({"doctor", "triangle.obj", "--as", "cloth"}, folder.path()).out == "triangle.obj: nothing found\n");
    CHECK(run_program({"doctor", "falling.toml", "--set", "gravity=[0,0,0]"}, folder.path()).out ==
          "falling.toml: nothing found\n");
    const ProgramRun run = run_program({"doctor", "falling.toml", "triangle.obj", "--json"}, folder.path());
    const auto json = nlohmann::json::parse(run.out).at("files");
    CHECK(json.at(0).at("findings").at(0).at("kind") == "free_fall");
    CHECK(json.at(1).at("findings").at(0).at("as") == "obstacle");
}

TEST_CASE("doctor says of a folder's scenes and meshes in a line each what is worst") {
    const TestFolder folder;
    CHECK(refused(run_program({"doctor", "."}, folder.path()), "no mesh file in this folder"));
    folder.write("a.obj", lone_triangle);
    folder.write("b.obj", "v 0 0 nan\n");
    folder.write("notes.txt", "no mesh");
    folder.write("falling.toml", falling_sheet());
    const ProgramRun run = run_program({"doctor", "."}, folder.path());
    CHECK(run.exit_code == 2);  // b.obj cannot be read
    CHECK(std::count(run.out.begin(), run.out.end(), '\n') == 3);
    CHECK(run.out.find("./a.obj: 0 errors, ") == 0);
    CHECK(run.out.find("./b.obj: 1 error, 0 warnings, 0 notes; ") != std::string::npos);
    REQUIRE(run.out.find("./falling.toml: ") != std::string::npos);
    CHECK(run.out.find("./falling.toml: ") > run.out.find("./b.obj"));
    const auto json = nlohmann::json::parse(run_program({"doctor", ".", "--json"}, folder.path()).out).at("files");
    CHECK(json.size() == 3);
}

TEST_CASE("doctor refuses files that are not there and options that make no sense") {
    const TestFolder folder;
    folder.write("triangle.obj", lone_triangle);
    CHECK(refused(run_program({"doctor", "triangle.obj", "none.obj"}, folder.path()), "none.obj: no such file"));
    CHECK(refused(run_program({"doctor", "/dev/null"}, folder.path()), "not a file"));
    folder.write("sheet.toml", sheet_on_box());
    CHECK(refused(run_program({"doctor", "sheet.toml", "--set", "step.scehme=rk4"}, folder.path()), "'scheme'"));
    CHECK(refused(run_program({"doctor", "sheet.toml", "--set", "duration=-1"}, folder.path()), "out of range"));
    CHECK(refused(run_program({"doctor"}, folder.path()), "FILE"));
    CHECK(refused(run_program({"doctor", "triangle.obj", "--as", "hat"}, folder.path()), "hat"));
}

}  // namespace percale::program::test::doctor_test
