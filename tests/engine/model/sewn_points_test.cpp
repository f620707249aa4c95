#include "engine/model/sewn_points.h"

#include "engine/model/seams.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/random.h"

namespace percale::test::sewn_points_test {

TEST_CASE("The pairs of a sewn point store the energy of its gap, and their forces are those of the gap") {
    Random random(3);
    for (int n = 0; n < 100; ++n) {
        const Stitch stitch{0, 1, 2, random.number(0.0, 1.0)};
        SpringNetwork network;
        for (const auto& [a, b] : {std::array{0, 1}, {0, 2}, {1, 2}}) append_pair(a, b, network);
        const SewnPoint point{stitch, random.decades(1e-2, 1e4), random.unit(), 0, 1};
        add_sewn_pairs(std::vector{point}, network);
        const std::vector<Vec3> x = {random.point(1.0), random.point(1.0), random.point(1.0)};
        double by_pairs = 0.0;
        for (int k = 0; k < 3; ++k) {
            by_pairs += 0.5 * network.bending[k] * (x[network.first[k]] - x[network.second[k]]).squaredNorm();
        }
        const double by_gap = sewn_energy(point, 0.0, to_vec3_arrays(x));
        CHECK(by_gap == Approx(0.5 * point.stiffness * sewn_gap(point, to_vec3_arrays(x)).squaredNorm()));
        CHECK(by_pairs == Approx(by_gap).epsilon(1e-10));
    }
}

TEST_CASE("Cloth without sewn points has no bending from them") {
    SpringNetwork network;
    append_pair(0, 1, network);
    add_sewn_pairs({}, network);
    CHECK(network.bending.empty());
}

TEST_CASE("Springs between vertices that their cloth's stitches join to one have no stiffness, and all others keep theirs") {
    ClothModel model;
    Fabric fabric = sheet_fabric();
    fabric.damping_time = 0.1;
    append_cloth(model, make_grid(1.0, 1.0, 4, 4), fabric, "sheet");
    append_cloth(model, make_grid(1.0, 1.0, 4, 4), fabric, "other");
    finish_model(model);
    const ClothModel before = model;
    // 0, 1 and 2 are joined through 15; 4 and 5 are joined only to a vertex of the other cloth; a point is no vertex.
    Seam seam{.length = {}, .from = 0.0, .over = 1.0};
    append_seam(std::vector<Stitch>{{15, 1, 1}, {0, 15, 15}, {2, 15, 15}, {4, 20, 20}, {5, 20, 20}, {8, 9, 10, 0.5}}, 40.0,
                to_vec3_arrays(model.rest), seam, model);
    finish_model(model);
    int left_out = 0;
    for (int k = 0; k < before.springs.size(); ++k) {
        const auto [low, high] = std::minmax({before.springs.first[k], before.springs.second[k]});
        const bool sewn = high <= 2;
        left_out += sewn;
        CHECK(model.springs.stiffness[k] == (sewn ? 0.0 : before.springs.stiffness[k]));
        CHECK(model.springs.damping[k] == (sewn ? 0.0 : before.springs.damping[k]));
    }
    CHECK(left_out == 3);  // two structural ones and a bend spring
    for (int k = 0; k < 5; ++k) CHECK(model.springs.stiffness[seam.first_spring + k] == 40.0);
}

TEST_CASE("Hinges of triangles with an edge whose ends are sewn together have no stiffness, and closed folds keep theirs") {
    const auto sewn = [](bool regular, Stitch stitch) {
        ClothModel model;
        Fabric fabric = sheet_fabric();
        fabric.springs.bend = 0.0;
        if (!regular) fabric.springs.shear = 0.0;
        fabric.bend_stiffness = 1e-3;
        TriangleMesh mesh = make_grid(1.0, 1.0, 3, 3);
        if (!regular) mesh.grid_columns = mesh.grid_rows = 0;
        append_whole_cloth(model, mesh, fabric, "sheet");
        const ClothRange& cloth = model.cloths[0];
        stitch = {cloth.index_of(stitch.vertex), cloth.index_of(stitch.from), cloth.index_of(stitch.to)};
        Seam seam{.length = {}, .from = 0.0, .over = 1.0};
        append_seam(std::vector{stitch}, 40.0, to_vec3_arrays(model.rest), seam, model);
        finish_model(model);
        const auto has = [&](const Hinge& h, int i) { return std::ranges::count(h.vertex, i) > 0; };
        int slack = 0;
        for (const Hinge& hinge : model.hinges.all) {
            const bool far = !hinge.folds || (std::ranges::count(std::span(hinge.vertex).subspan(2), stitch.vertex) > 0 &&
                                              std::ranges::count(std::span(hinge.vertex).subspan(2), stitch.other()) > 0);
            if (hinge.folds) {
                CHECK((hinge.stiffness == 0.0) == (has(hinge, stitch.vertex) && has(hinge, stitch.other()) && !far));
            }
            slack += hinge.stiffness == 0.0;
        }
        return slack;
    };
    // 3 and 4 share an edge of the middle row; 3 and 5 are two apart.
    CHECK(sewn(false, {3, 4, 4}) > 0);
    CHECK(sewn(false, {3, 5, 5}) == 0);
    CHECK(sewn(true, {3, 4, 4}) > 0);
    CHECK(sewn(true, {3, 5, 5}) == 0);
}

TEST_CASE("A strain limit of an edge whose ends are sewn together has no force and stays finite, whatever its hold was") {
    ClothModel model;
    Fabric fabric = sheet_fabric();
    fabric.strain_limit = 0.1;
    append_cloth(model, make_grid(1.0, 1.0, 4, 4), fabric, "sheet");
    finish_model(model);
    for (LimitedEdge& edge : model.limits.edges) model.limits.set_hold(edge, 0.5);
    const std::size_t edges = model.limits.edges.size();
    Seam seam{.length = {}, .from = 0.0, .over = 1.0};
    append_seam(std::vector<Stitch>{{0, 1, 1}}, 40.0, to_vec3_arrays(model.rest), seam, model);
    finish_model(model);
    REQUIRE(model.limits.edges.size() == edges);
    Vec3Arrays positions = to_vec3_arrays(model.rest);
    for (const double share : {1.0, 3.0, 0.0}) {
        positions.set(1, model.rest[0] + share * (model.rest[1] - model.rest[0]));
        CHECK(std::isfinite(limit_energy(model.limits, model.springs, positions)));
        CHECK(std::isfinite(tighten(model.limits, model.springs, positions, 0.5)));
        for (const LimitedEdge& edge : model.limits.edges) {
            if (model.springs.first[edge.spring] + model.springs.second[edge.spring] != 1) continue;
            CHECK(edge.hold <= edge.max_hold);
            CHECK(limit_tension(edge, model.springs, positions) < 1e-9);
        }
    }
}

}  // namespace percale::test::sewn_points_test
