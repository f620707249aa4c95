#include "measures/frame_certifier.h"

#include <random>
#include <vector>

#include "tests/support/catch.h"

namespace percale::scenes::test::frame_certifier_test {
namespace {

constexpr double limit = 0.3;

/// Two sheets and two bodies; some of them move from frame to frame, some through each other.
struct Scene {
    std::vector<TriangleMesh> cloths{make_grid(1, 1, 7, 7), make_grid(1, 1, 6, 6)},
        obstacles{make_box({0.4, 0.4, 0.4}), make_sphere(0.3, 1)};
    PairsOfCloths meeting = all_pairs(2);
    std::mt19937 random{3};

    Scene() {
        shift(cloths[0], {0.0, 0.35, 0.0});
        shift(cloths[1], {0.0, 0.4, 0.0});
        shift(obstacles[1], {0.6, 0.0, 0.1});
    }
    static void shift(TriangleMesh& mesh, const Vec3& way) {
        for (Vec3& x : mesh.vertices) x += way;
    }
    double number(double size) { return std::uniform_real_distribution<double>(-size, size)(random); }
    void crumple(TriangleMesh& mesh, double size) {
        for (Vec3& x : mesh.vertices) x += Vec3(number(size), number(size), number(size));
    }
    CertifiedShapes shapes() const { return {cloths, obstacles, {}, meeting}; }

    FrameCheck expected() const {
        FrameCheck check;
        for (const TriangleMesh& cloth : cloths) {
            for (const TriangleMesh& obstacle : obstacles) add_certificate(check, certify(cloth, obstacle, limit));
        }
        const MeetingMesh joined = joined_meeting_cloth(cloths, {}, meeting);
        if (!meeting.empty())
            add_cloth_certificate(check, certify_cloth(joined.mesh, joined.stitches, {joined.owner, &joined.pairs}));
        return check;
    }
};

void check_same(const FrameCheck& found, const FrameCheck& expected) {
    CHECK(found.intersections == expected.intersections);
    CHECK(found.touching_pairs == expected.touching_pairs);
    CHECK(found.vertices_inside == expected.vertices_inside);
    CHECK(found.deepest_penetration == expected.deepest_penetration);
    CHECK(found.smallest_distance == expected.smallest_distance);
}

}  // namespace

TEST_CASE("certificates of frames are those of each frame alone, whatever has moved since the last one") {
    Scene scene;
    FrameCertifier certifier({limit, limit});
    int crossing = 0;
    for (int frame = 0; frame < 60; ++frame) {
        if (frame % 4 == 1) scene.crumple(scene.cloths[frame / 4 % 2], 0.02);
        if (frame % 4 == 2)
            Scene::shift(scene.obstacles[frame / 4 % scene.obstacles.size()],
                         {scene.number(0.1), scene.number(0.1), scene.number(0.1)});
        if (frame == 30) scene.obstacles[0] = make_sphere(0.25, 2);  // other triangles
        if (frame == 40) scene.obstacles.pop_back();
        if (frame == 50) scene.meeting = {{1, 1}};
        const FrameCheck expected = scene.expected();
        check_same(certifier.check(scene.shapes()), expected);
        crossing += expected.intersections > 0;
    }
    CHECK(crossing > 5);
    CHECK(crossing < 60);
}

TEST_CASE("what has not moved is not tested again") {
    Scene scene;
    const std::atomic<bool> cancel = true;  // any test would be cancelled
    FrameCertifier certifier({limit, limit});
    const FrameCheck first = certifier.check(scene.shapes());
    check_same(certifier.check(scene.shapes(), &cancel), first);
    Scene::shift(scene.obstacles[1], {0.0, 0.1, 0.0});
    CHECK_THROWS_AS(certifier.check(scene.shapes(), &cancel), CertificateCancelled);
    check_same(certifier.check(scene.shapes()), scene.expected());
}

}  // namespace percale::scenes::test::frame_certifier_test
