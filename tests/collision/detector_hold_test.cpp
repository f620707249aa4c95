#include <algorithm>

#include "collision/detector.h"
#include "collision/obstacle/obstacle.h"
#include "tests/support/catch.h"
#include "tests/support/collision/scenes.h"
#include "tests/support/random.h"

namespace percale::test::detector_hold_test {
namespace {

/// A vertex on the top of a box near its ridge, and round the ridge at its side.
struct OverTheRidge {
    Steps steps;
    ContactRows rows;

    OverTheRidge() : steps(make_steps(Scene::box, triangle(), backends()[0])) {}
    static TriangleMesh triangle() {
        return {.vertices = {{0, 0, 0}, {0.02, 0.05, 0.003}, {0.02, 0.05, -0.003}}, .triangles = {{0, 1, 2}}};
    }
    /// Place of the first vertex from the ridge (x = 0.2, y = 0.15), in thicknesses.
    std::vector<Vec3> at(double x, double y) const {
        std::vector<Vec3> result = steps.cloth.vertices;
        for (Vec3& p : result) p += Vec3(0.2 + x * sheet_thickness, 0.15 + y * sheet_thickness, 0.04);
        return result;
    }
    /// Contacts of the first vertex with triangles of the top.
    int top_rows() const {
        int count = 0;
        const Obstacle box(steps.obstacles[0].mesh, {}, 0.0, make_brute_force_tree);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows.vertex[i][0] != 0 || rows.vertex[i][1] >= 0) continue;
            const Triangle& t = box.surface().triangles[rows.feature[i]];
            count += std::all_of(t.begin(), t.end(), [&](int v) { return box.at(v, 0).y() > 0.14; }) ? 1 : 0;
        }
        return count;
    }
};

}  // namespace

TEST_CASE("a contact stays one while it is near until the next refresh, even where it is no minimum any more") {
    OverTheRidge scene;
    // Beside the ridge, where only the side is nearest; the top's point is on the ridge, 31 degrees farther up.
    const auto top = scene.at(-0.02, 0.3), side = scene.at(0.3, -0.18);
    auto& detector = *scene.steps.detector;
    detector.refresh(top, top);
    detector.evaluate(top, 0.0, scene.rows);
    CHECK(scene.top_rows() == 1);
    detector.evaluate(side, 0.0, scene.rows);
    CHECK(scene.top_rows() == 1);
    const std::size_t held = scene.rows.size();
    detector.refresh(side, side);
    detector.evaluate(side, 0.0, scene.rows);
    CHECK(scene.top_rows() == 0);
    CHECK(scene.rows.size() < held);
    // Out of the thickness it is no row, back in it is one again.
    detector.refresh(top, top);
    detector.evaluate(top, 0.0, scene.rows);
    detector.evaluate(scene.at(-0.02, 1.1), 0.0, scene.rows);
    CHECK(scene.rows.size() == 0);
}

TEST_CASE("a contact also stays one when the cloth outruns its boxes and lists are made anew") {
    OverTheRidge scene;
    const auto top = scene.at(-0.3, 0.3), side = scene.at(0.6, -0.4);  // more than the room around a vertex
    auto& detector = *scene.steps.detector;
    detector.refresh(top, top);
    detector.evaluate(top, 0.0, scene.rows);
    REQUIRE(scene.top_rows() == 1);
    detector.evaluate(side, 0.0, scene.rows);
    CHECK(scene.top_rows() == 1);
    detector.refresh(side, side);
    detector.evaluate(side, 0.0, scene.rows);
    CHECK(scene.top_rows() == 0);
}

TEST_CASE("a contact gives way where cloth passes an edge, as its neighbour takes its place") {
    OverTheRidge scene;
    const auto top = scene.at(-0.02, 0.3), side = scene.at(0.3, -0.02);
    auto& detector = *scene.steps.detector;
    detector.refresh(top, top);
    detector.evaluate(top, 0.0, scene.rows);
    REQUIRE(scene.top_rows() == 1);
    detector.evaluate(side, 0.0, scene.rows);
    CHECK(scene.top_rows() == 0);
    // It has not ended: back where it was, it is one again.
    detector.evaluate(top, 0.0, scene.rows);
    CHECK(scene.top_rows() == 1);
}

}  // namespace percale::test::detector_hold_test
