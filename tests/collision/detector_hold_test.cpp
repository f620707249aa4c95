#include "collision/detector.h"
#include "tests/support/catch.h"
#include "tests/support/collision/scenes.h"
#include "tests/support/random.h"

namespace percale::test::detector_hold_test {
namespace {

/// A cloth edge across the ridge of a box.
struct OverTheRidge {
    Steps steps;
    ContactConstraints constraints;

    OverTheRidge() : steps(make_steps(Scene::box, {.vertices = std::vector<Vec3>(3), .triangles = {{0, 1, 2}}}, backends()[0])) {}

    /// Places where the edge's line is at (x, y) from the ridge (x = 0.2, y = 0.15) and perpendicular to that, in thicknesses.
    static std::vector<Vec3> at(double x, double y) {
        const Vec3 ridge(0.2, 0.15, 0.04), foot(x, y, 0.0), along = Vec3(-y, x, 0.0).normalized();
        std::vector<Vec3> places{foot + 0.5 * along, foot - 0.6 * along, Vec3(3.0, 0.0, 0.1)};
        for (Vec3& p : places) p = ridge + sheet_thickness * p;
        return places;
    }
    /// Contacts of the edge with the box's edges.
    int edge_constraints() const {
        int count = 0;
        for (const auto& vertex : constraints.vertex) count += vertex == std::array{0, 1, -1, -1} ? 1 : 0;
        return count;
    }
    int found_at(const std::vector<Vec3>& places, bool next_step) {
        if (next_step) steps.detector->update_candidates(places, places);
        steps.detector->find_contacts(places, 0.0, constraints);
        return edge_constraints();
    }
};

}  // namespace

TEST_CASE("a contact of edges stays one while it is near until the candidates are updated, even where it is no minimum") {
    OverTheRidge scene;
    // Seen from the ridge, the second place is below the box's top, beside its side: the side is nearer.
    const auto top = OverTheRidge::at(0.4, 0.04), side = OverTheRidge::at(0.4, -0.08);
    CHECK(scene.found_at(side, true) == 0);
    CHECK(scene.found_at(top, true) == 1);
    CHECK(scene.found_at(side, false) == 1);
    CHECK(scene.found_at(side, true) == 0);
    // Out of the thickness it is no constraint.
    CHECK(scene.found_at(top, true) == 1);
    CHECK(scene.found_at(OverTheRidge::at(1.1, 0.04), false) == 0);
}

TEST_CASE("a contact of edges also stays one when the cloth outruns its boxes and lists are rebuilt") {
    OverTheRidge scene;
    const auto top = OverTheRidge::at(0.2, 0.2), side = OverTheRidge::at(0.8, -0.3);  // more than the room around a vertex
    CHECK(scene.found_at(top, true) == 1);
    CHECK(scene.found_at(side, false) == 1);
    CHECK(scene.found_at(side, true) == 0);
}

}  // namespace percale::test::detector_hold_test
