#include "bodies/point_cache.h"

#include <cmath>
#include <limits>

#include "meshes/obj_file.h"
#include "tests/scenes/bodies/bending_bar.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::point_cache_test {
namespace {

struct Cached {
    TestFolder folder;
    TriangleMesh ball = make_sphere(0.25, 1);
    Scene scene;
    ObstacleSpec obstacle;

    Cached() {
        scene.file = folder.path("scene.toml");
        write_obj(folder.path("ball.obj"), ball.vertices, ball.triangles);
        obstacle.name = "ball";
        obstacle.mesh = "ball.obj";
    }

    /// Coordinates that float32 holds exactly.
    std::vector<Vec3> shape(int sample) const {
        std::vector<Vec3> x = ball.vertices;
        for (Vec3& p : x) {
            for (double& c : p) c = std::round(c * 1024.0) / 1024.0 + 0.25 * sample;
        }
        return x;
    }

    std::string samples(int count, bool big_endian) const {
        std::string bytes;
        for (int k = 0; k < count; ++k)
            for (const Vec3& x : shape(k))
                for (const double c : x) append_bytes(bytes, static_cast<float>(c), big_endian);
        return bytes;
    }

    std::string pc2(int count, std::int32_t points, float rate, int stored) const {
        std::string bytes("POINTCACHE2\0", 12);
        append_bytes(bytes, std::int32_t{1});
        append_bytes(bytes, points);
        append_bytes(bytes, 7.0f);
        append_bytes(bytes, rate);
        append_bytes(bytes, std::int32_t{count});
        return bytes + samples(stored, false);
    }

    std::string mdd(const std::vector<float>& times) const {
        std::string bytes;
        append_bytes(bytes, static_cast<std::int32_t>(times.size()), true);
        append_bytes(bytes, static_cast<std::int32_t>(ball.vertices.size()), true);
        for (const float time : times) append_bytes(bytes, time, true);
        return bytes + samples(static_cast<int>(times.size()), true);
    }

    std::string refusal(const std::string& name, const std::string& bytes) const {
        folder.write(name, bytes);
        ObstacleSpec with = obstacle;
        with.cache = name;
        return message_of([&] { PointCache(scene, with); });
    }
};

}  // namespace

TEST_CASE("A PC2 cache gives its samples at their times, straight lines in between") {
    Cached given;
    given.folder.write("ball.pc2", given.pc2(4, 42, 2.0f, 4));
    given.obstacle.cache = "ball.pc2";
    given.obstacle.fps = 10.0;
    PointCache cache(given.scene, given.obstacle);
    CHECK(cache.length() == Approx(0.6));
    CHECK(cache.frame_time() == Approx(0.2));
    CHECK(cache.text() == "4 frames in 0.6 s");
    CHECK(cache.mesh().triangles == given.ball.triangles);
    for (int k = 0; k < 4; ++k) CHECK(farthest_apart(cache.at(0.2 * k), given.shape(k)) < 1e-12);
    std::vector<Vec3> between = given.shape(1);
    for (Vec3& x : between) x += Vec3::Constant(0.0625);
    CHECK(farthest_apart(cache.at(0.25), between) < 1e-12);
    CHECK(cache.at(9.0) == given.shape(3));
}

TEST_CASE("An MDD cache has its own times, counted from its first, and is big endian") {
    Cached given;
    given.folder.write("ball.mdd", given.mdd({1.0f, 1.25f, 2.0f}));
    given.obstacle.cache = "ball.mdd";
    given.obstacle.unit = 0.01;
    PointCache cache(given.scene, given.obstacle);
    CHECK(cache.length() == 1.0);
    for (const auto& [time, sample] : {std::pair{0.0, 0}, {0.25, 1}, {1.0, 2}}) {
        std::vector<Vec3> shape = given.shape(sample);
        for (Vec3& x : shape) x *= 0.01;
        CHECK(farthest_apart(cache.at(time), shape) < 1e-15);
    }
}

TEST_CASE("A cache that does not fit its mesh, ends early or holds no numbers is refused by name") {
    Cached given;
    const auto says = [&](const std::string& name, const std::string& bytes, const std::string& what) {
        const std::string refusal = given.refusal(name, bytes);
        CAPTURE(refusal);
        return refusal.find(name) != std::string::npos && refusal.find(what) != std::string::npos;
    };
    CHECK(says("a.pc2", given.pc2(4, 43, 1.0f, 4), "43 points, the mesh has 42 vertices"));
    CHECK(says("a.pc2", given.pc2(4, 42, 1.0f, 3), "its header claims 2048"));
    CHECK(says("a.pc2", given.pc2(1, 42, 1.0f, 1), "1 sample, must be 2"));
    CHECK(says("a.pc2", given.pc2(4, 42, 0.0f, 4), "frames a sample"));
    CHECK(says("a.pc2", "POINTCACHE3", "does not begin with POINTCACHE2"));
    CHECK(says("a.pc2", "", "does not begin with POINTCACHE2"));
    CHECK(says("a.pc2", std::string("POINTCACHE2\0\1", 13), "ends too early"));
    CHECK(says("a.mdd", given.mdd({0.0f, 0.5f, 0.5f}), "times must ascend"));
    CHECK(says("a.mdd", "", "ends too early"));
    std::string negative;
    append_bytes(negative, std::int32_t{-5}, true);
    append_bytes(negative, std::int32_t{42}, true);
    CHECK(says("a.mdd", negative, "-5 samples"));
    CHECK(says("a.abc", "", ".pc2, .mdd"));
    given.obstacle.fps = 25.0;
    CHECK(says("b.mdd", given.mdd({0.0f, 0.5f}), "has its own times"));
    std::string bytes = given.pc2(2, 42, 1.0f, 2);
    const float lost = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(&bytes[32 + 12 * 42 + 4], &lost, 4);
    given.folder.write("lost.pc2", bytes);
    given.obstacle.cache = "lost.pc2";
    PointCache cache(given.scene, given.obstacle);
    CHECK(message_of([&] { cache.at(1.0); }).find("sample 1: vertex 0: coordinate y") != std::string::npos);
}

}  // namespace percale::scenes::test::point_cache_test
