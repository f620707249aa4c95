#include "engine/changes/remake.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::remake_test {
namespace {

/// Cloths of every kind, sewn to each other by springs, points and welds. `without`: the cloth that is left out from the start;
/// `fabric`: of the cloth of number 1.
struct Pieces {
    ClothModel model;
    std::vector<Seam> seams;
    int without;
    std::array<int, 4> first = {};

    explicit Pieces(int absent = -1, const Fabric& fabric = bending()) : without(absent) {
        TriangleMesh bent = make_sphere(0.3, 1), sheet = make_grid(0.4, 0.3, 5, 4);
        sheet.grid_columns = sheet.grid_rows = 0;
        add(0, sheet, limited());
        add(1, bent, fabric);
        sew(0, 1, {{3, 5, 5, 0.0}, {4, 7, 9, 0.25}}, true);
        add(2, make_grid(0.4, 0.3, 5, 4), woven());
        sew(1, 1, {{0, 8, 11, 0.5}}, false);
        add(3, sheet, limited());
        sew(2, 3, {{1, 2, 2, 0.0}, {2, 3, 4, 0.75}}, true);
        finish_model(model);
    }

    static Fabric limited() {
        Fabric fabric = free_fabric();
        fabric.strain_limit = 0.05;
        return fabric;
    }
    static Fabric bending() {
        Fabric fabric = free_fabric();
        fabric.springs.bend = 0.0;
        fabric.bend_stiffness = 1e-3;
        return fabric;
    }
    static Fabric woven() {
        Fabric fabric = bending();
        fabric.springs.structural = 0.0;
        fabric.stretch_stiffness = {{300.0, 200.0}};
        return fabric;
    }

    void add(int number, TriangleMesh mesh, const Fabric& fabric) {
        if (number == without) return;
        for (Vec3& x : mesh.vertices) x.y() += number;
        RestShape shape;
        if (number == 3) shape = rest_shape_of(mesh, mesh, "rest");
        first[number] = static_cast<int>(model.cloths.size());
        append_whole_cloth(model, mesh, fabric, "cloth " + std::to_string(number), shape);
    }

    void sew(int one, int other, std::vector<Stitch> stitches, bool weld) {
        if (one == without || other == without) return;
        const ClothRange &a = model.cloths[first[one]], &b = model.cloths[first[other]];
        for (Stitch& s : stitches) s = {a.index_of(s.vertex), b.index_of(s.from), b.index_of(s.to), s.share};
        Seam seam{.length = {}, .first_weld = weld ? static_cast<int>(model.welds.size()) : -1};
        append_seam(stitches, 40.0 + one, to_vec3_arrays(model.rest), seam, model);
        seams.push_back(seam);
    }

    /// Gives every weld and strain limit a hold of its own.
    void hold() {
        for (std::size_t k = 0; k < model.welds.size(); ++k) model.welds[k].hold = model.rest[model.welds[k].stitch.vertex];
        for (LimitedEdge& edge : model.limits.edges)
            model.limits.set_hold(edge, 1e-3 + model.rest[model.springs.first[edge.spring]].norm());
    }
};

template <class List>
void check_same_numbers(const List& a, const List& b) {
    CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
}

void check_same_springs(const SpringNetwork& a, const SpringNetwork& b) {
    CHECK(a.first == b.first);
    CHECK(a.second == b.second);
    CHECK(a.rest_length == b.rest_length);
    CHECK(a.stiffness == b.stiffness);
    CHECK(a.damping == b.damping);
    CHECK(a.kind == b.kind);
    CHECK(a.bending == b.bending);
}

void check_same_hinges(const Hinges& a, const Hinges& b) {
    CHECK(a.curved == b.curved);
    REQUIRE(a.all.size() == b.all.size());
    for (std::size_t k = 0; k < a.all.size(); ++k) {
        CHECK(a.all[k].vertex == b.all[k].vertex);
        CHECK(a.all[k].weight == b.all[k].weight);
        CHECK(a.all[k].stiffness == b.all[k].stiffness);
        CHECK(a.all[k].rest_angle == b.all[k].rest_angle);
        CHECK(a.all[k].pair == b.all[k].pair);
    }
}

void check_same_holds(const ClothModel& a, const ClothModel& b) {
    Holds one, other;
    copy_holds(a, one);
    copy_holds(b, other);
    CHECK(one.welds == other.welds);
    CHECK(one.limits == other.limits);
    REQUIRE(a.limits.edges.size() == b.limits.edges.size());
    for (std::size_t k = 0; k < a.limits.edges.size(); ++k) {
        CHECK(a.limits.edges[k].spring == b.limits.edges[k].spring);
        CHECK(a.limits.edges[k].length == b.limits.edges[k].length);
    }
    check_same_numbers(a.limits.slack_square, b.limits.slack_square);
}

void check_same(const ClothModel& a, const ClothModel& b) {
    CHECK(a.mass == b.mass);
    CHECK(a.thickness == b.thickness);
    CHECK(a.rest == b.rest);
    CHECK(a.triangles == b.triangles);
    check_same_springs(a.springs, b.springs);
    check_same_hinges(a.hinges, b.hinges);
    check_same_holds(a, b);
    REQUIRE(a.cloths.size() == b.cloths.size());
    for (std::size_t c = 0; c < a.cloths.size(); ++c) {
        CHECK(a.cloths[c].name == b.cloths[c].name);
        CHECK(a.cloths[c].first == b.cloths[c].first);
        CHECK(a.cloths[c].first_spring == b.cloths[c].first_spring);
        CHECK(a.cloths[c].order.place == b.cloths[c].order.place);
    }
    REQUIRE(a.sewn_points.size() == b.sewn_points.size());
    for (std::size_t k = 0; k < a.sewn_points.size(); ++k) {
        CHECK(a.sewn_points[k].stitch == b.sewn_points[k].stitch);
        CHECK(a.sewn_points[k].spring == b.sewn_points[k].spring);
        CHECK(a.sewn_points[k].pair == b.sewn_points[k].pair);
        CHECK(a.sewn_points[k].stiffness == b.sewn_points[k].stiffness);
    }
    REQUIRE(a.membrane.size() == b.membrane.size());
    for (std::size_t k = 0; k < a.membrane.size(); ++k) {
        CHECK(a.membrane[k].vertex == b.membrane[k].vertex);
        CHECK(a.membrane[k].stiffness == b.membrane[k].stiffness);
    }
    CHECK(a.bodies.size() == b.bodies.size());
    check_same_numbers(a.adjacency.other, b.adjacency.other);
    check_same_numbers(a.adjacency.stiffness, b.adjacency.stiffness);
    check_same_numbers(a.adjacency.bending, b.adjacency.bending);
}

void check_same(const std::vector<Seam>& a, const std::vector<Seam>& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        CHECK(a[k].first_spring == b[k].first_spring);
        CHECK(a[k].stitches == b[k].stitches);
        CHECK(a[k].length == b[k].length);
        CHECK(a[k].first_weld == b[k].first_weld);
    }
}

}  // namespace

TEST_CASE("Removing a cloth gives the model that is built without it, with its seams, hinges, points and all holds") {
    for (const int cloth : {0, 1, 2, 3}) {
        CAPTURE(cloth);
        Pieces whole, without(cloth);
        whole.hold();
        without.hold();
        const RemadeModel made = remake(whole.model, whole.seams, {.cloth = cloth});
        check_same(made.model, without.model);
        check_same(made.seams, without.seams);
        REQUIRE(made.seam_before.size() == made.seams.size());
        const ClothRange& gone = whole.model.cloths[cloth];
        for (int i = 0; i < whole.model.vertex_count(); ++i) {
            const bool there = i < gone.first || i >= gone.first + gone.count;
            CHECK(made.vertex[i] == (!there ? -1 : i < gone.first ? i : i - gone.count));
        }
    }
}

TEST_CASE("A model that is remade with its own fabric is unchanged") {
    for (const int cloth : {0, 1, 2, 3}) {
        CAPTURE(cloth);
        const Pieces whole;
        const Fabric same = whole.model.cloths[cloth].fabric;
        const RemadeModel made = remake(whole.model, whole.seams, {cloth, &same});
        check_same(made.model, whole.model);
        check_same(made.seams, whole.seams);
        for (int i = 0; i < whole.model.vertex_count(); ++i) CHECK(made.vertex[i] == i);
    }
}

TEST_CASE("A model with another fabric is the one that is built with it, and vertices are found under their new numbers") {
    Fabric plain = free_fabric(), tight = Pieces::limited(), hung = Pieces::woven();
    hung.stretch_stiffness = {{300.0, 300.0}};
    for (const Fabric& fabric : {plain, tight, hung}) {
        Pieces whole;
        const Pieces built(-1, fabric);
        const RemadeModel made = remake(whole.model, whole.seams, {1, &fabric});
        check_same(made.model, built.model);
        check_same(made.seams, built.seams);
        for (int i = 0; i < whole.model.vertex_count(); ++i) CHECK(made.model.rest[made.vertex[i]] == whole.model.rest[i]);
    }
}

TEST_CASE("The holds of a changed cloth's limits start from zero, and other holds stay") {
    Pieces whole;
    whole.hold();
    Fabric tight = Pieces::limited();
    tight.strain_limit = 0.01;
    const RemadeModel made = remake(whole.model, whole.seams, {0, &tight});
    const ClothRange& changed = made.model.cloths[0];
    REQUIRE(made.model.limits.edges.size() == whole.model.limits.edges.size());
    for (const LimitedEdge& edge : made.model.limits.edges) {
        const int vertex = made.model.springs.first[edge.spring];
        const double kept = 1e-3 + made.model.rest[vertex].norm();
        CHECK(edge.hold == (vertex < changed.first + changed.count ? 0.0 : kept));
    }
    for (std::size_t k = 0; k < made.model.welds.size(); ++k) CHECK(made.model.welds[k].hold == whole.model.welds[k].hold);
}

TEST_CASE("A fabric that the cloth cannot have is refused by its name") {
    const Pieces whole;
    Fabric wrong = free_fabric();
    wrong.springs.shear = 1.0;
    CHECK(mentions(scene_error([&] { remake(whole.model, whole.seams, {1, &wrong}); }), {"cloth 1", "springs.shear"}));
}

}  // namespace percale::test::remake_test
