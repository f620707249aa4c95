#include "scenes/measures/references.h"

#include "percale/error.h"
#include "scenes/format/expectations.h"
#include "scenes/format/scene_file.h"
#include "scenes/meshes/obj_file.h"
#include "scenes/run/run_scene.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::references_test {

TEST_CASE("each expectation has the vertices of its own file, others have none") {
    const TestFolder folder;
    const TriangleMesh one = make_grid(1.0, 1.0, 4, 4), other = make_grid(2.0, 1.0, 4, 4);
    write_obj(folder.path("one.obj"), one.vertices, one.triangles);
    write_obj(folder.path("other.obj"), other.vertices, other.triangles);
    const Scene scene = parse_scene(falling_sheet() +
                                        "[[expect]]\nat = 0.05\nmatches = { file = \"one.obj\", within = 1 }\n"
                                        "[[expect]]\nintersections = 0\nmatches = { file = \"other.obj\", within = 1 }\n",
                                    folder.path("test.toml"));
    const auto references = read_references(scene, 16);
    REQUIRE(references.size() == 3);
    CHECK(references[0] == one.vertices);
    CHECK(references[1].empty());
    CHECK(references[2] == other.vertices);
    CHECK_THROWS_WITH(read_references(scene, 17),
                      Catch::Contains("test.toml:20:1: matches: ") && Catch::Contains("has 16 vertices, the cloth has 17"));
    std::filesystem::remove(folder.path("other.obj"));
    CHECK_THROWS_AS(read_references(scene, 16), SceneError);
}

TEST_CASE("each `matches` is held against its own file") {
    const TestFolder folder;
    BuiltScene start = build_scene(parse_scene(falling_sheet(), "test.toml"));
    TriangleMesh mesh = start.cloth_meshes[0];
    for (const double shift : {1.0, 3.0}) {
        for (Vec3& x : mesh.vertices) x.x() += shift;
        write_obj(folder.path(shift == 1.0 ? "near.obj" : "far.obj"), mesh.vertices, mesh.triangles);
    }
    const std::string text = falling_sheet() +
                             "[[expect]]\nmatches = { file = \"far.obj\", within = 2 }\n"
                             "[[expect]]\nmatches = { file = \"near.obj\", within = 2 }\n";
    BuiltScene built = build_scene(parse_scene(text, folder.path("test.toml")));
    const RunResult result = run_scene(built);
    const std::vector<ExpectationResult> verdicts =
        judge_run(built.scene.expectations, result.measures, result.timed, built.scene);
    REQUIRE(verdicts.size() == 2);
    CHECK(*verdicts[0].value == Approx(4.0).epsilon(1e-3));
    CHECK_FALSE(verdicts[0].passed);
    CHECK(*verdicts[1].value == Approx(1.0).epsilon(1e-2));
    CHECK(verdicts[1].passed);
}

}  // namespace percale::scenes::test::references_test
