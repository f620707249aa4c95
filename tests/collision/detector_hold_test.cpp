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
    ContactConstraints constraints;

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
    int top_constraints() const {
        int count = 0;
        const Obstacle box(steps.obstacles[0].mesh, {}, 0.0, make_brute_force_tree);
        for (std::size_t i = 0; i < constraints.size(); ++i) {
            if (constraints.vertex[i][0] != 0 || constraints.vertex[i][1] >= 0) continue;
            const Triangle& t = box.surface().triangles[constraints.feature[i]];
            count += std::all_of(t.begin(), t.end(), [&](int v) { return box.at(v, 0).y() > 0.14; }) ? 1 : 0;
        }
        return count;
    }
};

}  // namespace

TEST_CASE("a contact stays one while it is near until the candidates are updated, even where it is no longer a minimum") {
    OverTheRidge scene;
    // Beside the ridge, where only the side is nearest; the top's point is on the ridge, 31 degrees farther up.
    const auto top = scene.at(-0.02, 0.3), side = scene.at(0.3, -0.18);
    auto& detector = *scene.steps.detector;
    detector.update_candidates(top, top);
    detector.find_contacts(top, 0.0, scene.constraints);
    CHECK(scene.top_constraints() == 1);
    detector.find_contacts(side, 0.0, scene.constraints);
    CHECK(scene.top_constraints() == 1);
    const std::size_t held = scene.constraints.size();
    detector.update_candidates(side, side);
    detector.find_contacts(side, 0.0, scene.constraints);
    CHECK(scene.top_constraints() == 0);
    CHECK(scene.constraints.size() < held);
    // Out of the thickness it is no constraint, back within it is one again.
    detector.update_candidates(top, top);
    detector.find_contacts(top, 0.0, scene.constraints);
    detector.find_contacts(scene.at(-0.02, 1.1), 0.0, scene.constraints);
    CHECK(scene.constraints.size() == 0);
}

TEST_CASE("a contact also stays one when the cloth outruns its boxes and lists are rebuilt") {
    OverTheRidge scene;
    const auto top = scene.at(-0.3, 0.3), side = scene.at(0.6, -0.4);  // more than the room around a vertex
    auto& detector = *scene.steps.detector;
    detector.update_candidates(top, top);
    detector.find_contacts(top, 0.0, scene.constraints);
    REQUIRE(scene.top_constraints() == 1);
    detector.find_contacts(side, 0.0, scene.constraints);
    CHECK(scene.top_constraints() == 1);
    detector.update_candidates(side, side);
    detector.find_contacts(side, 0.0, scene.constraints);
    CHECK(scene.top_constraints() == 0);
}

TEST_CASE("a contact gives way where cloth passes an edge, as its neighbour takes its place") {
    OverTheRidge scene;
    const auto top = scene.at(-0.02, 0.3), side = scene.at(0.3, -0.02);
    auto& detector = *scene.steps.detector;
    detector.update_candidates(top, top);
    detector.find_contacts(top, 0.0, scene.constraints);
    REQUIRE(scene.top_constraints() == 1);
    detector.find_contacts(side, 0.0, scene.constraints);
    CHECK(scene.top_constraints() == 0);
    // It has not ended: back where it was, it is one again.
    detector.find_contacts(top, 0.0, scene.constraints);
    CHECK(scene.top_constraints() == 1);
}

}  // namespace percale::test::detector_hold_test
