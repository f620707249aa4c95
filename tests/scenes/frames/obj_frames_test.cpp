#include "scenes/frames/obj_frames.h"

#include <fstream>

#include "scenes/frames/frame_folder.h"
#include "scenes/meshes/obj_file.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

using namespace percale;
using namespace percale::scenes;
using percale::scenes::test::TestFolder;

TEST_CASE("a frame as OBJ reads back with the same bits") {
    const TestFolder folder;
    FrameFolder files(folder.path());
    std::vector<TriangleMesh> cloths = {make_sphere(1.0 / 3.0, 1)};
    for (Vec3& x : cloths[0].vertices) x /= 7.0;
    const auto encoder = obj_frames().make({.cloths = {"ball"}, .obstacles = {}, .obstacle_moves = {}});
    const FrameFiles written = encoder->write({.index = 7, .time = 0.5, .cloths = cloths, .obstacles = {}}, files);
    REQUIRE(written.cloths == std::vector<std::string>{"frames/ball_00007.obj"});
    std::ifstream in(folder.path(written.cloths[0]));
    const TriangleMesh mesh = read_obj(in, written.cloths[0]);
    CHECK(mesh.vertices == cloths[0].vertices);
    CHECK(mesh.triangles == cloths[0].triangles);
    CHECK(encoder->first_frame_of(written.cloths[0]) == 7);
}
