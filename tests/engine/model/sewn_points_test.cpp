#include "engine/model/sewn_points.h"

#include "engine/forces/hinge_bending.h"
#include "engine/model/seams.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/random.h"

namespace percale::test {

TEST_CASE("The pairs of a sewn point store what its gap stores, and their forces are its") {
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
        const double by_gap = sewn_energy(point, 0.0, to_vectors(x));
        CHECK(by_gap == Approx(0.5 * point.stiffness * sewn_gap(point, to_vectors(x)).squaredNorm()));
        CHECK(by_pairs == Approx(by_gap).epsilon(1e-10));
    }
}

TEST_CASE("Cloth without sewn points has no bending of theirs") {
    SpringNetwork network;
    append_pair(0, 1, network);
    add_sewn_pairs({}, network);
    CHECK(network.bending.empty());
}

TEST_CASE("Edges whose ends are sewn to one vertex hold nothing, nor do the triangles beside them") {
    ClothModel model;
    TriangleMesh roll = make_cylinder(0.5, 1.0, 12);
    Fabric fabric = sheet_fabric();
    fabric.springs.shear = fabric.springs.bend = 0.0;
    fabric.bend_stiffness = 1e-3;
    append_whole_cloth(model, roll, fabric, "roll");
    append_cloth(model, make_grid(1.0, 1.0, 2, 2), sheet_fabric(), "patch");
    finish_model(model);
    const ClothModel before = model;
    REQUIRE(before.hinges.curved.size() > 4);
    // Two neighbours, by way of a vertex of the other cloth.
    const auto [a, b, c] = model.triangles[0];
    const int between = model.cloths[1].first;
    const Vectors positions = to_vectors(model.rest);
    Seam seam{.length = {}, .from = 0.0, .over = 1.0};
    append_seam(std::vector<Stitch>{{b, between, between}, {a, between, between}}, 40.0, positions, seam, model);
    finish_model(model);

    const auto is_sewn = [&](int i) { return i == a || i == b; };
    for (int k = 0; k < before.springs.size(); ++k) {
        const bool sewn = is_sewn(before.springs.first[k]) && is_sewn(before.springs.second[k]);
        CHECK(model.springs.stiffness[k] == (sewn ? 0.0 : before.springs.stiffness[k]));
        CHECK(model.springs.damping[k] == (sewn ? 0.0 : before.springs.damping[k]));
    }
    std::size_t left_out = 0;
    for (std::size_t k = 0; k < before.hinges.all.size(); ++k) {
        const Hinge &hinge = model.hinges.all[k], &old = before.hinges.all[k];
        const bool sewn = std::ranges::count_if(old.vertex, is_sewn) == 2;
        left_out += sewn && old.rest_angle != 0.0;
        CHECK(hinge.stiffness == (sewn ? 0.0 : old.stiffness));
        CHECK(hinge.rest_angle == (sewn ? 0.0 : old.rest_angle));
    }
    CHECK(left_out > 0);
    CHECK(model.hinges.curved.size() == before.hinges.curved.size() - left_out);
    for (int k = 0; k < 2; ++k) CHECK(model.springs.stiffness[seam.first_spring + k] == 40.0);

    // Closed, all is finite.
    Vectors closed = positions;
    closed.set(b, closed.at(a));
    Vectors forces = to_vectors(std::vector<Vec3>(model.rest.size(), Vec3::Zero()));
    CHECK(std::isfinite(hinge_energy(model.hinges, closed)));
    CHECK(std::isfinite(add_curved_hinges(model.hinges, closed, forces)));
    for (int i = 0; i < model.vertex_count(); ++i) CHECK(forces.at(i).allFinite());
}

TEST_CASE("A hinge whose far vertices are sewn together holds as before, and a spring between them does not") {
    ClothModel model;
    Fabric fabric = sheet_fabric();
    fabric.springs.bend = 0.0;
    fabric.bend_stiffness = 1e-3;
    append_whole_cloth(model, make_grid(1.0, 1.0, 3, 3), fabric, "sheet");
    append_cloth(model, make_grid(1.0, 1.0, 3, 3), sheet_fabric(), "with bend springs");
    Seam seam{.length = {}, .from = 0.0, .over = 1.0};
    append_seam(std::vector<Stitch>{{3, 5, 5}, {12, 14, 14}}, 40.0, to_vectors(model.rest), seam, model);
    finish_model(model);
    for (const Hinge& hinge : model.hinges.all) CHECK(hinge.stiffness > 0.0);
    const SpringNetwork& springs = model.springs;
    int bend = 0;
    for (int k = 0; k < springs.size(); ++k) {
        if (springs.kind[k] != SpringKind::bend) continue;
        const bool sewn = springs.first[k] + springs.second[k] == 26 && std::abs(springs.first[k] - springs.second[k]) == 2;
        bend += sewn;
        CHECK((springs.stiffness[k] == 0.0) == sewn);
    }
    CHECK(bend == 1);
}

TEST_CASE("Of a membrane the triangles at an edge whose ends are sewn together hold nothing") {
    ClothModel model;
    Fabric fabric = sheet_fabric();
    fabric.springs = {};
    fabric.stretch_stiffness = {100.0, 100.0};
    append_whole_cloth(model, make_grid(1.0, 1.0, 3, 3), fabric, "sheet");
    finish_model(model);
    REQUIRE(model.membrane.size() == 8);
    Seam seam{.length = {}, .from = 0.0, .over = 1.0};
    append_seam(std::vector<Stitch>{{3, 4, 4}}, 40.0, to_vectors(model.rest), seam, model);
    finish_model(model);
    for (const MembraneTriangle& triangle : model.membrane) {
        const auto at = [&](int i) { return std::ranges::count(triangle.vertex, i) == 1; };
        CHECK((triangle.stiffness.norm() == 0.0) == (at(3) && at(4)));
    }
}

}  // namespace percale::test
