#include "engine/model/strain_limits.h"

#include "engine/tolerances.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::strain_limits_test {
namespace {

Fabric limited_fabric(double strain) {
    Fabric fabric = sheet_fabric();
    fabric.strain_limit = strain;
    return fabric;
}

/// The limited edge between two vertices.
LimitedEdge& edge_between(ClothModel& model, int first, int second) {
    for (LimitedEdge& edge : model.limits.edges) {
        if (model.springs.first[edge.spring] == first && model.springs.second[edge.spring] == second) return edge;
    }
    FAIL("no such edge");
    return model.limits.edges.front();
}

}  // namespace

TEST_CASE("Rows and columns of a limited cloth are limited, its diagonals and other cloth are not") {
    ClothModel model;
    append_cloth(model, make_grid(0.2, 0.3, 3, 4), sheet_fabric(), "free");
    append_cloth(model, make_grid(0.2, 0.3, 3, 4), limited_fabric(0.1), "limited");
    finish_model(model);
    CHECK(model.limits.edges.size() == 4 * 2 + 3 * 3);
    for (const LimitedEdge& edge : model.limits.edges) {
        CHECK(model.springs.kind[edge.spring] == SpringKind::structural);
        CHECK(model.springs.first[edge.spring] >= 12);
        CHECK(edge.length == Approx(1.1 * 0.1));
        CHECK(edge.stiffness == Approx(limit_stiffness * 1000.0));
        for (const int entry : edge.entry) CHECK(model.adjacency.spring[entry] == edge.spring);
        CHECK(edge.entry[0] != edge.entry[1]);
    }
    CHECK(cloth_model(make_grid(0.2, 0.3, 3, 4), sheet_fabric()).limits.empty());
}

TEST_CASE("A limit of cloth without structural springs is refused") {
    Fabric fabric = limited_fabric(0.1);
    fabric.springs.structural = 0.0;
    CHECK(mentions(scene_error([&] { cloth_model(make_grid(0.2, 0.2, 3, 3), fabric); }), {"strain_limit", "structural"}));
}

TEST_CASE("Holds of edges stay when cloth is added") {
    ClothModel model = cloth_model(make_grid(0.2, 0.2, 3, 3), limited_fabric(0.1));
    model.limits.set_hold(model.limits.edges[4], 2.5);
    append_cloth(model, make_grid(0.2, 0.2, 3, 3), limited_fabric(0.2), "another");
    finish_model(model);
    REQUIRE(model.limits.edges.size() == 24);
    for (std::size_t k = 0; k < 24; ++k) CHECK(model.limits.edges[k].hold == (k == 4 ? 2.5 : 0.0));
    for (const int entry : model.limits.edges[4].entry) CHECK(model.limits.hold[entry] == 2.5);
}

TEST_CASE("The hold of a too long edge grows and that of a too short one falls, between zero and the maximum") {
    ClothModel model = cloth_model(make_grid(0.2, 0.2, 3, 3), limited_fabric(0.1));
    Vec3Arrays x = to_vec3_arrays(model.rest);
    LimitedEdge& edge = edge_between(model, 0, 1);
    const double k = edge.stiffness;
    const auto lengthen = [&](double length) { x.set(0, x.at(1) - Vec3(length, 0.0, 0.0)); };
    lengthen(0.113);
    double before = limit_energy(model.limits, model.springs, x);
    double work = tighten(model.limits, model.springs, x, 0.5);
    CHECK(edge.hold == Approx(0.5 * k * 0.003));
    CHECK(work == Approx(limit_energy(model.limits, model.springs, x) - before));
    CHECK(limit_tension(edge, model.springs, x) == Approx(1.5 * k * 0.003));
    lengthen(0.109);
    before = limit_energy(model.limits, model.springs, x);
    work = tighten(model.limits, model.springs, x, 1.0);
    CHECK(edge.hold == Approx(0.5 * k * 0.001));
    CHECK(work == Approx(limit_energy(model.limits, model.springs, x) - before));
    CHECK(work < 0.0);
    lengthen(0.1);
    CHECK(limit_tension(edge, model.springs, x) == 0.0);
    tighten(model.limits, model.springs, x, 1.0);
    CHECK(edge.hold == 0.0);
    lengthen(2.0);
    for (int n = 0; n < 10; ++n) tighten(model.limits, model.springs, x, 1.0);
    CHECK(edge.hold == Approx(max_held_strain * 1000.0 * 0.1));
}

TEST_CASE("Holds are copied and restored, in the layout of the kernels, too") {
    ClothModel model = cloth_model(make_grid(0.2, 0.2, 3, 3), limited_fabric(0.1));
    model.limits.set_hold(model.limits.edges[3], 7.0);
    Holds holds;
    copy_holds(model, holds);
    model.limits.set_hold(model.limits.edges[3], 9.0);
    put_holds(holds, model);
    for (const int entry : model.limits.edges[3].entry) CHECK(model.limits.hold[entry] == 7.0);
    CHECK(model.limits.edges[3].hold == 7.0);
}

}  // namespace percale::test::strain_limits_test
