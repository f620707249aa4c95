#include "scenes/frames/obj_frames.h"

#include <fstream>
#include <sstream>

#include "scenes/frames/frame_folder.h"
#include "scenes/meshes/obj_file.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::obj_frames_test {
namespace {

/// The coordinates of two squares and how they are joined, as an OBJ file may say it.
constexpr const char* quads =
    "mtllib cloth.mtl\no towel\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 2 0 0\nv 2 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 1 0\n"
    "g left\nusemtl blue\nf 1/1/1 2/2/1 3/3/1 4/4/1\ng right\nf 2/1/1 5/2/1 6/3/1 3/4/1\n";

}  // namespace

TEST_CASE("frames of a mesh keep what its file has, one that has changed since does not count") {
    const TestFolder folder;
    const std::string file = folder.write("towel.obj", quads);
    std::ifstream in(file);
    std::vector<TriangleMesh> cloths = {read_obj(in, file)};
    cloths[0].vertices[4] = Vec3(1.5, 0.5, 0.25);
    const FrameCast cast{.cloths = {"towel"}, .obstacles = {}, .obstacle_moves = {}, .cloth_files = {file}};
    FrameFolder files(folder.path());
    const auto write = [&](int index) {
        const FrameFiles written = obj_frames().make(cast)->write({.index = index, .cloths = cloths, .obstacles = {}}, files);
        return folder.read(written.cloths[0]);
    };
    const std::string text = write(0);
    for (const char* kept : {"mtllib ../cloth.mtl\n", "o towel\n", "v 1.5 0.5 0.25\n", "vt 1 1\n",
                             "usemtl blue\nf 1/1 2/2 3/3 4/4\n", "g right\nf 2/1 5/2 6/3 3/4\n"}) {
        CAPTURE(kept);
        CHECK(text.find(kept) != std::string::npos);
    }
    CHECK(text.find("vn") == std::string::npos);
    std::istringstream again(text);
    const TriangleMesh read = read_obj(again, "frame");
    CHECK(read.vertices == cloths[0].vertices);
    CHECK(read.triangles == cloths[0].triangles);
    folder.write("towel.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    CHECK(write(1).find("\nf 1 2 3\nf 1 3 4\n") != std::string::npos);
    std::filesystem::remove(file);
    CHECK(write(2).find("\nf 1 2 3\nf 1 3 4\n") != std::string::npos);
}

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

}  // namespace percale::scenes::test::obj_frames_test
