#include "scenes/export/reference_files.h"

#include "percale/error.h"
#include "scenes/format/scene_file.h"
#include "scenes/meshes/mesh_import.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::reference_files_test {
namespace {

/// Runs without reading the files, and writes them.
std::vector<std::string> updated(const TestFolder& folder, const std::string& expect) {
    BuiltScene built = build_scene(parse_scene(falling_sheet() + expect, folder.path("test.toml")));
    const RunResult result = run_scene(built, {}, {.compare = false});
    return update_references(built, result);
}

double height_of(const TestFolder& folder, const std::string& file) { return import_mesh(folder.path(file)).vertices[0].y(); }

}  // namespace

TEST_CASE("the file of each `matches` is written from the state of its time, and again unchanged") {
    const TestFolder folder;
    const std::string expect =
        "[[expect]]\nat = 0.05\nmatches = { file = \"half.obj\", within = 1e-9 }\n"
        "[[expect]]\nmatches = { file = \"end.ply\", within = 1e-9 }\n";
    CHECK(updated(folder, expect) ==
          std::vector<std::string>{"matches half.obj at 0.05 s: written, 16 vertices", "matches end.ply: written, 16 vertices"});
    // y_k = 2 - g dt^2 k (k + 1) / 2
    CHECK(height_of(folder, "half.obj") == Approx(2.0 - 9.81e-4 * 15));
    CHECK(height_of(folder, "end.ply") == Approx(2.0 - 9.81e-4 * 55));
    CHECK(updated(folder, expect) ==
          std::vector<std::string>{"matches half.obj at 0.05 s: unchanged", "matches end.ply: unchanged"});
}

TEST_CASE("what cannot be written is refused before anything is") {
    const TestFolder folder;
    const std::string good = "[[expect]]\nmatches = { file = \"good.obj\", within = 1 }\n";
    const auto refused = [&](const std::string& table, const std::string& why) {
        CHECK_THROWS_WITH(updated(folder, good + table), Catch::Contains(why));
        CHECK_FALSE(folder.holds("good.obj"));
    };
    refused("[[expect]]\nmatches = { file = \"end.stl\", within = 1 }\n", "end.stl: --update writes .obj and .ply");
    refused("[[expect]]\nduring = [0, 1]\nmatches = { file = \"end.obj\", within = 1 }\n", "is of many shapes");
    refused("[[expect]]\nat = 0.05\nmatches = { file = \"good.obj\", within = 1 }\n", "good.obj is named twice");
    refused("[[expect]]\nat = 7\nmatches = { file = \"end.obj\", within = 1 }\n", "the run did not reach 7 s");
}

}  // namespace percale::scenes::test::reference_files_test
