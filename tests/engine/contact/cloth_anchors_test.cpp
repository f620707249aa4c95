#include "engine/contact/cloth_anchors.h"

#include "engine/contact/friction.h"
#include "tests/support/catch.h"
#include "tests/support/random.h"

namespace percale::test::cloth_anchors_test {
namespace {

constexpr double h = 0.005, mu = 0.4, normal = 3.0;
const Vec3 up(0, 1, 0);

/// A vertex 0 above a sheet of two triangles, and an edge 5-6 across its diagonal.
struct Sheet {
    Vec3Arrays x;
    ContactConstraints constraints;

    Sheet() {
        x.resize(9);
        x.set(1, Vec3(0, 0, 0));
        x.set(2, Vec3(0.1, 0, 0));
        x.set(3, Vec3(0, 0, 0.1));
        x.set(4, Vec3(0.1, 0, 0.1));
        x.set(0, Vec3(0.049, 0.8 * h, 0.049));
        x.set(5, Vec3(0.0, 0.8 * h, 0.0));
        x.set(6, Vec3(0.1, 0.8 * h, 0.1));
    }
    void add(const std::array<int, 4>& vertex, const std::array<double, 4>& weight, const Vec3& direction = up) {
        constraints.vertex.push_back(vertex);
        constraints.weight.push_back(weight);
        constraints.direction.push_back(direction);
        constraints.thickness.push_back(h);
        constraints.friction.push_back(mu);
        constraints.obstacle.push_back(-1);
        constraints.feature.push_back(1);
    }
    ClothFrictionContact contact(const FrictionStart& start, int constraint, const Vec3Arrays& end, double force = normal) const {
        return cloth_friction_contact(start, constraints, constraint, force, end);
    }
};

}  // namespace

TEST_CASE("The anchor of a vertex stays with its material points when the vertex passes from face to face") {
    Sheet sheet;
    sheet.add({0, 1, 2, 3}, {1.0, -0.02, -0.49, -0.49});  // just inside the first face
    sheet.add({0, 2, 4, 3}, {1.0, -0.49, -0.02, -0.49});  // the same place on the other
    const FrictionStart first{.positions = &sheet.x};
    Vec3Arrays end = sheet.x;
    end.set(0, end.at(0) + Vec3(2e-5, 0, 0));
    std::vector<ClothAnchor> left;
    AnchorKeeper().keep(sheet.constraints, std::vector{sheet.contact(first, 0, end)}, left);
    REQUIRE(left.size() == 1);
    CHECK(left[0].vertex == sheet.constraints.vertex[0]);
    CHECK((left[0].stretch - Vec3(2e-5, 0, 0)).norm() < 1e-15);
    ClothAnchors anchors;
    anchors.set(left);
    const FrictionStart next{.positions = &end, .cloth_anchors = &anchors};
    Vec3Arrays moved = end;
    moved.set(0, end.at(0) + Vec3(1e-5, 0, 0));
    for (const int constraint : {0, 1}) {
        const ClothFrictionContact contact = sheet.contact(next, constraint, moved);
        CHECK(contact.had_anchor);
        CHECK(contact.vertex == left[0].vertex);
        CHECK((contact.slip - Vec3(3e-5, 0, 0)).norm() < 1e-15);
        CHECK((contact.moved - Vec3(1e-5, 0, 0)).norm() < 1e-15);
    }
    // Cloth that does not move keeps its anchors to the last bit.
    std::vector<ClothAnchor> again;
    AnchorKeeper().keep(sheet.constraints, std::vector{sheet.contact(next, 1, end)}, again);
    REQUIRE(again.size() == 1);
    CHECK((again[0].vertex == left[0].vertex && again[0].weight == left[0].weight && again[0].stretch == left[0].stretch));
}

TEST_CASE("An anchor that slides is dragged along within the stick threshold, by the constraint's own points") {
    Sheet sheet;
    sheet.add({0, 2, 4, 3}, {1.0, -0.49, -0.02, -0.49});
    const FrictionStart first{.positions = &sheet.x};
    Vec3Arrays end = sheet.x;
    end.set(0, end.at(0) + Vec3(0, 0, 3e-3));
    std::vector<ClothAnchor> left;
    AnchorKeeper().keep(sheet.constraints, std::vector{sheet.contact(first, 0, end)}, left);
    REQUIRE(left.size() == 1);
    CHECK((left[0].stretch - Vec3(0, 0, 0.01 * h)).norm() < 1e-15);
    CHECK(left[0].weight == sheet.constraints.weight[0]);
}

TEST_CASE("A vertex between two sheets has an anchor on each side, the one where it is pressed harder of several on one side") {
    Sheet sheet;
    sheet.add({0, 1, 2, 3}, {1.0, -0.02, -0.49, -0.49});
    sheet.add({0, 2, 4, 3}, {1.0, -0.49, -0.02, -0.49}, Vec3(0.1, 1, 0).normalized());
    sheet.add({0, 1, 2, 3}, {1.0, -0.02, -0.49, -0.49}, -up);
    const FrictionStart first{.positions = &sheet.x};
    std::vector<ClothFrictionContact> contacts;
    for (const int constraint : {0, 1, 2}) contacts.push_back(sheet.contact(first, constraint, sheet.x, normal + constraint));
    std::vector<ClothAnchor> left;
    AnchorKeeper().keep(sheet.constraints, contacts, left);
    REQUIRE(left.size() == 2);
    CHECK(left[0].normal == -up);
    CHECK(left[1].vertex == sheet.constraints.vertex[1]);
    ClothAnchors anchors;
    anchors.set(left);
    CHECK(anchors.find(sheet.constraints, 2, sheet.x)->normal == -up);
    CHECK(anchors.find(sheet.constraints, 0, sheet.x)->vertex == sheet.constraints.vertex[1]);
}

TEST_CASE("Edges find the anchor of the edges beside them, where it is near; a subtracted constraint leaves none") {
    Sheet sheet;
    sheet.add({5, 6, 2, 3}, {0.49, 0.51, -0.5, -0.5});  // the diagonal
    const FrictionStart first{.positions = &sheet.x};
    std::vector<ClothAnchor> left;
    AnchorKeeper().keep(sheet.constraints, std::vector{sheet.contact(first, 0, sheet.x)}, left);
    REQUIRE(left.size() == 1);
    CHECK(!is_of_vertex(left[0].weight));
    ClothAnchors anchors;
    anchors.set(left);
    CHECK(anchors.find(sheet.constraints, 0, sheet.x) != nullptr);
    sheet.add({5, 6, 2, 4}, {0.49, 0.51, -0.5, -0.5});  // 5 cm away
    CHECK(anchors.find(sheet.constraints, 1, sheet.x) == nullptr);
    sheet.add({5, 6, 3, 4}, {0.5, 0.5, -0.99, -0.01});
    sheet.x.set(3, Vec3(0.0505, 0, 0.0505));
    sheet.x.set(2, Vec3(0.05, 0, 0.05));
    CHECK(anchors.find(sheet.constraints, 2, sheet.x) != nullptr);
    sheet.constraints.direction[2] = -up;
    CHECK(anchors.find(sheet.constraints, 2, sheet.x) == nullptr);
    AnchorKeeper().keep(sheet.constraints, std::vector{sheet.contact(first, 0, sheet.x, -normal)}, left);
    CHECK(left.empty());
}

}  // namespace percale::test::cloth_anchors_test
