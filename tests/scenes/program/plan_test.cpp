#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/scenes/program/run_program.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::program::test::plan_test {
using percale::scenes::test::sheet_on_box;

TEST_CASE("plan prints the plan of a scene and writes nothing") {
    const TestFolder folder;
    folder.write("sheet.toml", sheet_on_box());
    const ProgramRun run = run_program({"plan", "sheet.toml"}, folder.path());
    CHECK(run.exit_code == 0);
    CHECK(run.error.empty());
    CHECK(run.out.find("36, 0 pinned") != std::string::npos);
    CHECK(run.out.find("motion of obstacles: ") != std::string::npos);
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) files += entry.exists();
    CHECK(files == 1);
}

TEST_CASE("plan takes overrides, --no-skip and --json") {
    const TestFolder folder;
    folder.write("sheet.toml", sheet_on_box());
    const ProgramRun run = run_program({"plan", "sheet.toml", "--json", "--no-skip", "--set", "cloth.sheet.pin=[0]", "--set",
                                        "fabric.sheet.springs.bend=0", "--set", "fabric.sheet.self_contact=true"},
                                       folder.path());
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(run.out);
    CHECK(json.at("pinned_vertices") == 1);
    std::vector<std::string> absent;
    for (const auto& skip : json.at("skipped")) absent.push_back(skip.at("what"));
    CHECK(absent == std::vector<std::string>{"bending springs of sheet", "closing of seams", "triangle springs of sheet",
                                             "strain limit of sheet", "hinges of sheet", "drag of the air", "pressure in sheet"});
}

TEST_CASE("plan refuses what run refuses") {
    const TestFolder folder;
    folder.write("sheet.toml", sheet_on_box());
    CHECK(refused(run_program({"plan", "none.toml"}, folder.path()), "none.toml"));
    CHECK(refused(run_program({"plan", "sheet.toml", "--set", "step.skip=maybe"}, folder.path()), "true or false"));
    CHECK(refused(run_program({"plan", "sheet.toml", "--set", "step.skpi=true"}, folder.path()), "skip"));
}

}  // namespace percale::program::test::plan_test
