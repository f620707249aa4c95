#include "scenes/frames/ply_frames.h"

#include <fstream>

#include "scenes/frames/frame_folder.h"
#include "scenes/meshes/ply_file.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::ply_frames_test {

TEST_CASE("a frame as PLY reads back with the same bits and names the fields of its cloth") {
    const TestFolder folder;
    FrameFolder files(folder.path());
    std::vector<TriangleMesh> cloths = {make_grid(0.3, 1.0 / 7.0, 4, 5)}, obstacles = {make_sphere(0.1, 1)};
    const std::vector<MeshFields> fields = {{.vertex = {{"distance", std::vector<double>(20, 0.5)}}, .triangle = {}}};
    const FrameFormat format = ply_frames();
    CHECK(format.holds_fields);
    const auto encoder = format.make({.cloths = {"sheet"}, .obstacles = {"ball"}, .obstacle_moves = {false}});
    const FrameFiles written =
        encoder->write({.index = 0, .time = 0.5, .cloths = cloths, .obstacles = obstacles, .cloth_fields = fields}, files);
    REQUIRE(written.cloths == std::vector<std::string>{"frames/sheet_00000.ply"});
    REQUIRE(written.obstacles == std::vector<std::string>{"obstacles/ball_00000.ply"});
    std::ifstream in(folder.path(written.cloths[0]), std::ios::binary);
    const TriangleMesh mesh = read_ply(in, written.cloths[0]);
    CHECK(mesh.vertices == cloths[0].vertices);
    CHECK(mesh.triangles == cloths[0].triangles);
    CHECK(folder.read(written.cloths[0]).find("property float distance") != std::string::npos);
    CHECK(folder.read(written.obstacles[0]).find("property float") == std::string::npos);
}

}  // namespace percale::scenes::test::ply_frames_test
