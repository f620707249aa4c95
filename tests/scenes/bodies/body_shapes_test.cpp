#include "bodies/body_shapes.h"

#include <cmath>
#include <limits>

#include "format/scene_file.h"
#include "meshes/obj_file.h"
#include "percale/certify.h"
#include "run/run_scene.h"
#include "tests/scenes/bodies/bending_bar.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/watched_run.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::body_shapes_test {
namespace {

/// A ball that moves along x by 0.1 m a frame, ten frames a second.
struct Rolling {
    TestFolder folder;
    TriangleMesh ball = make_sphere(0.25, 1);
    Scene scene;
    ObstacleSpec obstacle;

    explicit Rolling(std::vector<double> places = {0.0, 0.1, 0.2, 0.3}) {
        scene.file = folder.path("scene.toml");
        for (std::size_t k = 0; k < places.size(); ++k)
            write_obj(folder.path("ball" + std::to_string(k) + ".obj"), at(places[k]), ball.triangles);
        write_obj(folder.path("start.obj"), at(-1.0), ball.triangles);
        obstacle.name = "ball";
        obstacle.mesh = "ball%d.obj";
        obstacle.frames = std::array{0, static_cast<int>(places.size()) - 1};
        obstacle.fps = 10.0;
    }

    std::vector<Vec3> at(double place) const {
        std::vector<Vec3> x = ball.vertices;
        for (Vec3& p : x) p.x() += place;
        return x;
    }

    /// Where the ball is at each of the times; NaN where it is not as it was.
    std::vector<double> places(const std::vector<double>& times) const {
        BodyShapes shapes(scene, obstacle);
        std::vector<double> places;
        for (const double time : times) {
            const std::vector<Vec3> shape = shapes.at(time);
            const double place = shape[0].x() - ball.vertices[0].x();
            places.push_back(farthest_apart(shape, at(place)) < 1e-9 ? place : std::nan(""));
        }
        return places;
    }

    std::string refusal() const {
        return message_of([&] { BodyShapes(scene, obstacle); });
    }
};

void check_near(const std::vector<double>& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t k = 0; k < a.size(); ++k) CHECK(std::abs(a[k] - b[k]) < 1e-9);
}

}  // namespace

TEST_CASE("What is played begins at the time and at the shape that the scene says, and its last shape stays") {
    Rolling rolling;
    check_near(rolling.places({0.0, 0.15, 0.3, 2.0}), {0.0, 0.15, 0.3, 0.3});
    rolling.obstacle.play_from = 1.0;
    rolling.obstacle.play_offset = 0.1;
    check_near(rolling.places({0.0, 1.0, 1.05, 1.2, 5.0}), {0.1, 0.1, 0.15, 0.3, 0.3});
    CHECK(BodyShapes(rolling.scene, rolling.obstacle).end() == Approx(1.2));
    rolling.obstacle.play_offset = 0.3;
    CHECK(rolling.refusal().find("play_offset = 0.3 s must be below the 0.3") != std::string::npos);
}

TEST_CASE("A lead-in goes straight from the start mesh to the first shape") {
    Rolling rolling;
    rolling.obstacle.lead_in = 0.5;
    CHECK(rolling.refusal().find("needs start_mesh") != std::string::npos);
    rolling.obstacle.start_mesh = "start.obj";
    rolling.obstacle.play_from = 1.0;
    check_near(rolling.places({0.0, 1.0, 1.25, 1.5, 1.6, 9.0}), {-1.0, -1.0, -0.5, 0.0, 0.1, 0.3});
    const BodyShapes shapes(rolling.scene, rolling.obstacle);
    CHECK(farthest_apart(shapes.first().vertices, rolling.at(-1.0)) < 1e-9);
    CHECK(shapes.end() == Approx(1.8));
    rolling.obstacle.lead_in = 0.0;
    CHECK(rolling.refusal() == "start_mesh needs a lead_in");
    rolling.obstacle.lead_in = 1.0;
    write_obj(rolling.folder.path("start.obj"), make_sphere(0.25, 2).vertices, make_sphere(0.25, 2).triangles);
    CHECK(rolling.refusal().find("start.obj: 162 vertices") != std::string::npos);
}

TEST_CASE("A loop closes at once where its ends are the same, and within a frame where they are not") {
    Rolling open;
    open.obstacle.loop = true;
    check_near(open.places({0.3, 0.35, 0.4, 0.5, 0.75, 4.1}), {0.3, 0.15, 0.0, 0.1, 0.15, 0.1});
    Rolling closed({0.0, 0.1, 0.2, 0.1, 0.0});
    closed.obstacle.loop = true;
    check_near(closed.places({0.3, 0.4, 0.5, 4.2}), {0.1, 0.0, 0.1, 0.2});
    const BodyShapes shapes(closed.scene, closed.obstacle);
    CHECK(shapes.end() == std::numeric_limits<double>::infinity());
    CHECK(shapes.text() == "5 frames in 0.4 s, again and again");
    closed.obstacle.play_from = 1.0;
    closed.obstacle.play_offset = 0.1;
    CHECK(BodyShapes(closed.scene, closed.obstacle).text() ==
          "5 frames in 0.4 s, again and again, the first time without its first 0.1 s, from 1 s on");
}

TEST_CASE("Keys of what is played are refused without it, and so are two sources at once") {
    Rolling rolling;
    rolling.obstacle.clip = "walk";
    CHECK(rolling.refusal().find("exclude each other") != std::string::npos);
    ObstacleSpec still;
    still.mesh = "ball0.obj";
    CHECK(message_of([&] { check_still(rolling.scene, still); }).empty());
    const auto refused = [&](auto change) {
        ObstacleSpec other = still;
        change(other);
        return message_of([&] { check_still(rolling.scene, other); }).find("needs frames = [first, last], cache or clip") !=
               std::string::npos;
    };
    CHECK(refused([](ObstacleSpec& o) { o.fps = 10.0; }));
    CHECK(refused([](ObstacleSpec& o) { o.start_mesh = "a.obj"; }));
    CHECK(refused([](ObstacleSpec& o) { o.lead_in = 1.0; }));
    CHECK(refused([](ObstacleSpec& o) { o.play_from = 1.0; }));
    CHECK(refused([](ObstacleSpec& o) { o.play_offset = 1.0; }));
    CHECK(refused([](ObstacleSpec& o) { o.loop = true; }));
    still.mesh = "ball%d.obj";
    CHECK(message_of([&] { check_still(rolling.scene, still); }).find("frames = [first, last]") != std::string::npos);
}

TEST_CASE("A sheet held by a bar that bends by its clip goes along with it, and a run on it is resumed in every bit") {
    const TestFolder folder;
    BendingBar().write_gltf(folder);
    const Scene scene = load_scene(folder.write("scene.toml", R"(
duration = 1.0
[fabric.felt]
thickness = 0.01
springs = { structural = 500.0, shear = 100.0, bend = 1.0 }
[[cloth]]
name = "flag"
fabric = "felt"
grid = { size = [0.5, 0.5], vertices = [9, 9] }
pose = { translation = [0.37, 1.75, 0.0] }
pin = { box = [[0.1, 1.0, -1.0], [0.13, 2.0, 1.0]], to = "bar" }
[[obstacle]]
name = "bar"
mesh = "bar.gltf"
clip = "bend"
[expect]
intersections = 0
)"),
                                   {});
    BuiltScene built = build_scene(scene);
    const RunResult result = run_scene(built, {});
    REQUIRE(result.status == RunStatus::finished);
    CHECK(result.measures.intersections == 0);
    // The first column hangs beside the upper half, which has turned by a quarter: its middle has gone from y = 1.75 to x =
    // -0.75.
    const auto positions = built.simulation.positions(built.cloths[0]);
    for (int k = 0; k < 9; ++k) CHECK(positions[static_cast<std::size_t>(9 * k)].x() < -0.4);
    const WatchedRun plain = watch(scene, {}), left = watch(scene, {.checkpoint_every = 0.3});
    CHECK(plain.hashes == left.hashes);
    REQUIRE(left.states.size() >= 2);
    for (std::size_t k = 0; k < left.states.size(); ++k)
        CHECK(resumes_as(plain, left, k, watch(scene, {.from = &left.states[k]})));
}

}  // namespace percale::scenes::test::body_shapes_test
