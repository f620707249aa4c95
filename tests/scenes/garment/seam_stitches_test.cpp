#include "scenes/garment/seam_stitches.h"

#include "scenes/format/scene_file.h"
#include "scenes/run/scene_build.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::seam_stitches_test {
namespace {

constexpr const char* head =
    "[fabric.f]\nsprings = { structural = 100.0 }\n"
    "[[cloth]]\nname = \"a\"\nfabric = \"f\"\nmesh = \"a.obj\"\n";
constexpr const char* grid = "[[cloth]]\nname = \"b\"\nfabric = \"f\"\ngrid = { size = [1, 1], vertices = [3, 3] }\n";
constexpr const char* two_triangles =
    "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 3 0 0\nv 4 0 0\nv 3 0 1\nf 1 2 3\nf 4 5 6\nstitch 0 3\nstitch 1 3 4 0.5\n";

Scene scene_with(const test::TestFolder& folder, const std::string& text) {
    folder.write("a.obj", two_triangles);
    return load_scene(folder.write("scene.toml", head + text));
}

std::string fault(const std::string& text) {
    const test::TestFolder folder;
    return error_of([&] { build_scene(scene_with(folder, text)); });
}

}  // namespace

TEST_CASE("a seam has the pairs and points of the scene file, and those of its own file") {
    const test::TestFolder folder;
    folder.write("more.txt", "2 5\n");
    const std::string said = "[[seam]]\nvertices = [[0, 3]]\npoints = [[1, 3, 4, 0.5]]\n";
    const Scene scene = scene_with(folder, said + "file = \"more.txt\"\n[[seam]]\nfile = \"mesh\"\n");
    CHECK(seam_stitches(scene, scene.seams[0]) == std::vector<Stitch>{{0, 3, 3}, {1, 3, 4, 0.5}, {2, 5, 5}});
    CHECK(seam_stitches(scene, scene.seams[1]) == std::vector<Stitch>{{0, 3, 3}, {1, 3, 4, 0.5}});
    CHECK(seam_cloths(scene, scene.seams[0]) == std::array{0, 0});
    BuiltScene built = build_scene(scene);
    REQUIRE(built.seams.size() == 2);
    CHECK(built.seams[0].name == "seam 0");
    CHECK(built.simulation.seam_gaps(built.seams[1].id)[0] == 3.0);
}

TEST_CASE("what a seam cannot join is reported at its place") {
    CHECK(fault(std::string(grid) + "[[seam]]\nvertices = [[0, 3]]\n").find("seam lacks cloths: the scene has 2") !=
          std::string::npos);
    CHECK(fault(std::string(grid) + "[[seam]]\ncloths = [\"a\", \"b\"]\nfile = \"mesh\"\n").find("is of one cloth") !=
          std::string::npos);
    CHECK(fault(std::string(grid) + "[[seam]]\ncloths = [\"b\", \"b\"]\nfile = \"mesh\"\n").find("cloth 'b' has no mesh file") !=
          std::string::npos);
    CHECK(fault("[[seam]]\nfile = \"none.txt\"\n").find("none.txt: cannot be read") != std::string::npos);
    CHECK(fault("[[seam]]\nname = \"hem\"\npoints = [[0, 3, 9, 0.5]]\n").find("there is no vertex 9") != std::string::npos);
    CHECK(fault("[[seam]]\npoints = [[0, 3, 4, 1.5]]\n").find("seam.0.points[0][3]") != std::string::npos);
}

TEST_CASE("stitches are counted through the vertices of all cloth that is not left out") {
    const std::vector<ClothStitches> seams = {{{0, 2}, {{1, 2, 3, 0.5}}}, {{0, 1}, {{4, 5, 5}}}, {{2, 2}, {{0, 1, 1}}}};
    const std::vector<int> first = {0, -1, 10};
    CHECK(joined_stitches(seams, first) == std::vector<Stitch>{{1, 12, 13, 0.5}, {10, 11, 11}});
}

}  // namespace percale::scenes::test::seam_stitches_test
