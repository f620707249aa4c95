#include "bodies/mesh_sequence.h"

#include <cmath>
#include <limits>

#include "format/scene_file.h"
#include "meshes/obj_file.h"
#include "percale/certify.h"
#include "run/run_scene.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/scenes/watched_run.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::mesh_sequence_test {
namespace {

/// A ball that swells and sinks, written as frames.
struct BallFrames {
    TestFolder folder;
    TriangleMesh ball = make_sphere(0.2, 2);
    int count;

    explicit BallFrames(int frames = 9) : count(frames) {
        for (int k = 0; k < frames; ++k) write_obj(folder.path("ball" + std::to_string(k) + ".obj"), shape(k), ball.triangles);
    }

    std::vector<Vec3> shape(int frame) const {
        std::vector<Vec3> x = ball.vertices;
        for (Vec3& p : x) p = Vec3((1.0 + 0.03 * frame) * p.x(), p.y() - 0.01 * frame * p.z(), p.z());
        return x;
    }

    ObstacleSpec spec() const {
        ObstacleSpec obstacle;
        obstacle.name = "ball";
        obstacle.mesh = "ball%d.obj";
        obstacle.frames = std::array{0, count - 1};
        obstacle.fps = 10.0;
        return obstacle;
    }

    Scene empty_scene() const {
        Scene scene;
        scene.file = folder.path("scene.toml");
        return scene;
    }

    Scene scene(const std::vector<Override>& overrides = {}) const {
        return load_scene(folder.write("scene.toml", R"(
title = "a sheet on a ball that swells"
duration = 0.7
[fabric.felt]
thickness = 0.005
springs = { structural = 500.0, shear = 100.0, bend = 1.0 }
[[cloth]]
name = "sheet"
fabric = "felt"
grid = { size = [0.6, 0.6], vertices = [13, 13] }
pose = { translation = [0.0, 0.215, 0.0] }
[[obstacle]]
name = "ball"
mesh = "ball%d.obj"
frames = [0, )" + std::to_string(count - 1) + R"(]
fps = 10.0
[expect]
intersections = 0
)"),
                          overrides);
    }
};

}  // namespace

TEST_CASE("A frame's number takes the place of %d, padded to the digits asked for") {
    CHECK(frame_pattern("walk/shell%d.obj").name_of(12) == "walk/shell12.obj");
    CHECK(frame_pattern("a%04db.ply").name_of(7) == "a0007b.ply");
    CHECK(frame_pattern("%02d").name_of(123) == "123");
    for (const char* name : {"none.obj", "%s.obj", "%4d.obj", "%d_%d.obj", "end%", "%0d.obj"}) {
        CAPTURE(name);
        CHECK(message_of([&] { frame_pattern(name); }).find("%04d") != std::string::npos);
    }
}

TEST_CASE("Vertices go straight from frame to frame, and stay before the first and after the last") {
    const BallFrames frames;
    MeshSequence sequence(frames.empty_scene(), frames.spec());
    CHECK(sequence.mesh().triangles == frames.ball.triangles);
    CHECK(sequence.at(-1.0) == frames.shape(0));
    for (const double time : {0.0, 0.3, 0.8, 5.0, 0.1}) {
        CHECK(sequence.at(time) == frames.shape(std::min(8, static_cast<int>(std::lround(10.0 * time)))));
    }
    const std::vector<Vec3> between = sequence.at(0.475), before = frames.shape(4), after = frames.shape(5);
    for (std::size_t i = 0; i < between.size(); ++i) CHECK((between[i] - (0.25 * before[i] + 0.75 * after[i])).norm() < 1e-12);
    CHECK(sequence.length() == Approx(0.8));
    CHECK(sequence.text() == "9 frames in 0.8 s");
}

TEST_CASE("Frames that are missing, of another mesh, without an order or without numbers are refused by name") {
    const BallFrames frames;
    const Scene scene = frames.empty_scene();
    ObstacleSpec obstacle = frames.spec();
    obstacle.frames = std::array{0, 9};
    CHECK(message_of([&] { MeshSequence(scene, obstacle); }).find("ball9.obj") != std::string::npos);
    obstacle.frames = std::array{5, 5};
    CHECK(message_of([&] { MeshSequence(scene, obstacle); }).find("[5, 5]") != std::string::npos);
    write_obj(frames.folder.path("ball3.obj"), make_sphere(0.2, 1).vertices, make_sphere(0.2, 1).triangles);
    frames.folder.write("ball5.obj", "v 0 0 nan\n");
    obstacle = frames.spec();
    MeshSequence sequence(scene, obstacle);
    const std::string other = message_of([&] { sequence.at(0.25); });
    CHECK(other.find("ball3.obj") != std::string::npos);
    CHECK(other.find("42 vertices and 80 triangles") != std::string::npos);
    CHECK(message_of([&] { sequence.at(0.5); }).find("ball5.obj:1") != std::string::npos);
    obstacle.mesh = "ball%d.stl";
    CHECK(message_of([&] { MeshSequence(scene, obstacle); }).find("OBJ, OFF or PLY") != std::string::npos);
}

TEST_CASE("Cloth on a ball that swells by its frames: the frames that are written are those of the files, none crosses") {
    const BallFrames frames;
    BuiltScene built = build_scene(frames.scene({{"output.fps", "10"}}));
    std::vector<Frame> written;
    RunHooks hooks;
    hooks.frame = [&](const Frame& frame) { written.push_back(frame); };
    const RunResult result = run_scene(built, hooks);
    REQUIRE(result.status == RunStatus::finished);
    CHECK(result.measures.intersections == 0);
    REQUIRE(written.size() == 8);
    for (std::size_t k = 0; k < written.size(); ++k) {
        double apart = 0.0;
        const std::vector<Vec3> shape = frames.shape(static_cast<int>(k));
        for (std::size_t i = 0; i < shape.size(); ++i)
            apart = std::max(apart, (written[k].obstacles[0].vertices[i] - shape[i]).norm());
        CHECK(apart < 1e-9);
        CHECK(certify(written[k].cloths[0], written[k].obstacles[0], 0.01).clean());
    }
}

TEST_CASE("A run that meets a bad frame fails there, with what it has, and rest waits for the last frame") {
    const BallFrames frames;
    frames.folder.write("ball5.obj", "v 0 0 nan\n");
    BuiltScene built = build_scene(frames.scene());
    int written = 0;
    RunHooks hooks;
    hooks.frame = [&](const Frame&) { ++written; };
    const RunResult result = run_scene(built, hooks);
    CHECK(result.status == RunStatus::failed);
    CHECK(result.reason.find("ball5.obj:1") != std::string::npos);
    CHECK(result.totals.simulated_s > 0.35);
    CHECK(written > 5);
    CHECK(message_of([&] {
              build_scene(frames.scene({{"duration", "rest"}, {"max_duration", "0.5"}}));
          }).find("what it plays goes on until 0.8 s") != std::string::npos);
}

TEST_CASE("A run on frames is resumed in every bit, and goes on until the last frame") {
    const BallFrames frames(5);
    const Scene scene = frames.scene();
    const WatchedRun plain = watch(scene, {}), left = watch(scene, {.checkpoint_every = 0.2});
    CHECK(plain.hashes == left.hashes);
    REQUIRE(left.states.size() >= 2);
    for (std::size_t k = 0; k < left.states.size(); ++k)
        CHECK(resumes_as(plain, left, k, watch(scene, {.from = &left.states[k]})));
    const Scene until_rest = frames.scene({{"duration", "rest"}, {"step.kinetic_damping", "true"}});
    BuiltScene built = build_scene(until_rest);
    const RunResult result = run_scene(built, {});
    CHECK(result.totals.simulated_s > 0.4);
}

}  // namespace percale::scenes::test::mesh_sequence_test
