#include "scenes/frames/glb_frames.h"

#include "scenes/frames/frame_folder.h"
#include "tests/scenes/frames/glb_reader.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::glb_frames_test {

TEST_CASE("a run is one GLB file, made at its end from what grew beside it, by whichever encoder wrote which frame") {
    const TestFolder folder;
    const FrameCast cast{.cloths = {"sheet"}, .obstacles = {"floor", "ball"}, .obstacle_moves = {false, true}};
    FrameFolder files(folder.path());
    const auto frame_at = [](TriangleMesh mesh, int index) {
        for (Vec3& x : mesh.vertices) x.y() += 0.125 * index;
        return mesh;
    };
    for (int index = 0; index < 4; ++index) {
        const std::vector<TriangleMesh> cloths = {frame_at(make_grid(1.0, 1.0, 3, 3), index)};
        const std::vector<TriangleMesh> obstacles = {make_plane(2.0), frame_at(make_box({1, 1, 1}), -index)};
        const FrameFiles written = glb_frames().make(cast)->write(
            {.index = index, .time = 0.5 * index, .cloths = cloths, .obstacles = obstacles}, files);
        CHECK(written.cloths == std::vector<std::string>{"frames/scene.glb"});
        CHECK(written.obstacles == std::vector<std::string>{"frames/scene.glb", "frames/scene.glb"});
        CHECK_FALSE(folder.holds("frames/scene.glb"));
    }
    const auto encoder = glb_frames().make(cast);
    encoder->finish(std::vector<double>{0.0, 0.5, 1.0, 1.5}, files);
    files.finish();
    const GlbReader glb(folder.read("frames/scene.glb"));
    REQUIRE(glb.json["nodes"].size() == 3);
    CHECK(glb.json["animations"][0]["channels"].size() == 2);
    for (std::size_t key = 0; key < 4; ++key) {
        CHECK(glb.morphed(0, key)[1] == 0.125f * static_cast<float>(key));
        CHECK(glb.morphed(2, key)[1] == glb.morphed(2, 0)[1] - 0.125f * static_cast<float>(key));
    }
    CHECK(encoder->first_frame_of("frames/scene.glb.samples") == 0);
    CHECK(encoder->first_frame_of("frames/scene_00000.glb") == -1);
    CHECK(encoder->is_made_at_end("frames/scene.glb"));
    CHECK_FALSE(encoder->is_made_at_end("frames/scene.glb.samples"));
}

}  // namespace percale::scenes::test::glb_frames_test
