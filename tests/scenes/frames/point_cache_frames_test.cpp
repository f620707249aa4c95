#include "scenes/frames/point_cache_frames.h"

#include "scenes/bodies/point_cache.h"
#include "scenes/common/bytes.h"
#include "scenes/frames/frame_folder.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::point_cache_frames_test {
namespace {

TriangleMesh shifted(const TriangleMesh& mesh, double shift) {
    TriangleMesh moved = mesh;
    for (Vec3& x : moved.vertices) x += Vec3(shift, 0.1 * shift, 1.0 / 3.0);
    return moved;
}

const FrameCast cast{.cloths = {"sheet"}, .obstacles = {"floor", "ball"}, .obstacle_moves = {false, true}, .fps = 25.0};

/// Frames 0, 1, 2 of a sheet, a floor that rests and a ball that moves; the last as written.
FrameFiles write_three(const FrameFormat& format, const TestFolder& folder) {
    FrameFolder files(folder.path());
    FrameFiles last;
    for (int index = 0; index < 3; ++index) {
        const std::vector<TriangleMesh> cloths = {shifted(make_grid(1.0, 1.0, 3, 3), index)};
        const std::vector<TriangleMesh> obstacles = {make_plane(2.0), shifted(make_sphere(0.2, 1), -index)};
        // A new encoder for every frame, as in resumed runs.
        last = format.make(cast)->write({.index = index, .time = 0.04 * index, .cloths = cloths, .obstacles = obstacles}, files);
    }
    format.make(cast)->finish(std::vector<double>{0.0, 0.04, 0.08}, files);
    files.finish();
    return last;
}

/// The shapes that a body would play.
std::vector<Vec3> played(const TestFolder& folder, const std::string& start, const std::string& ending, double time) {
    Scene scene;
    ObstacleSpec body;
    body.mesh = folder.path(start + ".mesh.obj");
    body.cache = folder.path(start + ending);
    if (ending == ".pc2") body.fps = cast.fps;
    PointCache cache(scene, body);
    CHECK(cache.length() == Approx(0.08));
    return cache.at(time);
}

}  // namespace

TEST_CASE("point caches play on the mesh beside them what cloths and bodies did") {
    for (const FrameFormat& format : {pc2_frames(), mdd_frames()}) {
        const TestFolder folder;
        const std::string ending = "." + format.word;
        CAPTURE(ending);
        const FrameFiles files = write_three(format, folder);
        CHECK(files.cloths == std::vector<std::string>{"frames/sheet" + ending});
        CHECK(files.obstacles == std::vector<std::string>{"obstacles/floor.mesh.obj", "obstacles/ball" + ending});
        CHECK(files.others == std::vector<std::string>{"frames/sheet.mesh.obj", "obstacles/ball.mesh.obj"});
        CHECK(folder.file_count() == 5);
        for (int index = 0; index < 3; ++index) {
            const std::vector<Vec3> sheet = played(folder, "frames/sheet", ending, 0.04 * index);
            const std::vector<Vec3> wanted = shifted(make_grid(1.0, 1.0, 3, 3), index).vertices;
            REQUIRE(sheet.size() == wanted.size());
            for (std::size_t v = 0; v < wanted.size(); ++v) CHECK((sheet[v] - wanted[v]).norm() < 5e-7);
            CHECK((played(folder, "obstacles/ball", ending, 0.04 * index)[0] - shifted(make_sphere(0.2, 1), -index).vertices[0])
                      .norm() < 5e-7);
        }
    }
}

TEST_CASE("the headers are those of the formats, byte by byte") {
    const TestFolder folder;
    write_three(pc2_frames(), folder);
    const std::string pc2 = folder.read("frames/sheet.pc2");
    CHECK(pc2.substr(0, 12) == std::string("POINTCACHE2\0", 12));
    CHECK(little_at<std::uint32_t>(pc2.data() + 12) == 1);
    CHECK(little_at<std::uint32_t>(pc2.data() + 16) == 9);
    CHECK(float_at(pc2.data() + 20) == 0.0f);
    CHECK(float_at(pc2.data() + 24) == 1.0f);
    CHECK(little_at<std::uint32_t>(pc2.data() + 28) == 3);
    CHECK(pc2.size() == 32 + 3 * 9 * 12);
    write_three(mdd_frames(), folder);
    std::string start;
    append_big(start, std::uint32_t{3});
    append_big(start, std::uint32_t{9});
    for (const double time : {0.0, 0.04, 0.08}) append_big_float(start, time);
    const std::string mdd = folder.read("frames/sheet.mdd");
    CHECK(mdd.substr(0, start.size()) == start);
    CHECK(mdd.size() == start.size() + 3 * 9 * 12);
}

TEST_CASE("an encoder knows its files by name") {
    const auto encoder = mdd_frames().make(cast);
    for (const char* name : {"frames/sheet.mdd", "frames/sheet.mdd.samples", "frames/sheet.mesh.obj", "obstacles/ball.mdd",
                             "obstacles/floor.mesh.obj"})
        CHECK(encoder->first_frame_of(name) == 0);
    for (const char* name :
         {"frames/sheet.pc2", "obstacles/floor.mdd", "frames/sheet.obj", "frames/ball.mdd", "frames/sheet_00000.obj"})
        CHECK(encoder->first_frame_of(name) == -1);
    CHECK(encoder->is_made_at_end("frames/sheet.mdd"));
    CHECK_FALSE(encoder->is_made_at_end("frames/sheet.mesh.obj"));
    CHECK_FALSE(pc2_frames().make(cast)->is_made_at_end("frames/sheet.pc2"));
}

}  // namespace percale::scenes::test::point_cache_frames_test
