#include "scenes/frames/numbered_frames.h"

#include "scenes/frames/frame_folder.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::numbered_frames_test {
namespace {

std::unique_ptr<FrameEncoder> counted_vertices(const FrameCast& cast) {
    return numbered_frames(cast, ".count", [](const std::string& path, const NumberedMesh& shape) {
        write_whole_file(path, std::to_string(shape.mesh.vertices.size()));
    });
}

TriangleMesh points(std::size_t count) { return {.vertices = std::vector<Vec3>(count, Vec3::Zero()), .triangles = {}}; }

}  // namespace

TEST_CASE("every mesh of every frame has a file with its name and number, an obstacle that rests only one") {
    const TestFolder folder;
    FrameFolder files(folder.path());
    const auto encoder =
        counted_vertices({.cloths = {"shirt", "skirt"}, .obstacles = {"floor", "ball"}, .obstacle_moves = {false, true}});
    FrameFiles last;
    for (int index = 0; index < 3; ++index) {
        const std::vector<TriangleMesh> cloths = {points(1), points(2)}, obstacles = {points(3), points(4)};
        last = encoder->write({.index = index, .time = 0.1 * index, .cloths = cloths, .obstacles = obstacles}, files);
    }
    CHECK(last.cloths == std::vector<std::string>{"frames/shirt_00002.count", "frames/skirt_00002.count"});
    CHECK(last.obstacles == std::vector<std::string>{"obstacles/floor_00000.count", "obstacles/ball_00002.count"});
    CHECK(folder.read("frames/skirt_00001.count") == "2");
    CHECK(folder.read("obstacles/floor_00000.count") == "3");
    CHECK(folder.file_count() == 3 * 2 + 1 + 3);
}

TEST_CASE("the number of a frame is read from a file's name, whatever else stands in the folder") {
    const auto encoder = counted_vertices({.cloths = {"shirt", "shirt_00001"}, .obstacles = {"ball"}, .obstacle_moves = {true}});
    CHECK(encoder->first_frame_of("frames/shirt_00012.count") == 12);
    CHECK(encoder->first_frame_of("frames/shirt_123456.count") == 123456);
    CHECK(encoder->first_frame_of("frames/shirt_00001_00003.count") == 3);
    CHECK(encoder->first_frame_of("obstacles/ball_00000.count") == 0);
    for (const char* name :
         {"frames/shirt_12.count", "frames/shirt_00012.obj", "frames/shirts_00012.count", "frames/ball_00012.count",
          "obstacles/shirt_00012.count", "frames/shirt_0001x.count", "frames/shirt_1234567890.count", "frames/shirt_.count",
          "frames/shirt_00012", "shirt_00012.count", ""}) {
        CAPTURE(name);
        CHECK(encoder->first_frame_of(name) == -1);
    }
}

}  // namespace percale::scenes::test::numbered_frames_test
