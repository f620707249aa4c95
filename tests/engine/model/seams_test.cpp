#include "engine/model/seams.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::seams_test {
namespace {

struct Sewn {
    ClothModel model;
    Vec3Arrays positions;
    Seam seam;

    /// Two grids, the second 0.3 m above the first, sewn together at two corners and, within the first, across it.
    Sewn() {
        TriangleMesh upper = make_grid(1.0, 1.0, 4, 4);
        for (Vec3& x : upper.vertices) x.y() += 0.3;
        append_cloth(model, make_grid(1.0, 1.0, 4, 4), sheet_fabric(), "lower");
        append_cloth(model, upper, sheet_fabric(), "upper");
        positions = to_vec3_arrays(model.rest);
        seam.from = 2.0;
        seam.over = 0.5;
        append_seam(std::vector<Stitch>{{0, 16, 16}, {31, 15, 15}, {0, 3, 3}}, 40.0, positions, seam, model);
        finish_model(model);
    }
};

}  // namespace

TEST_CASE("A seam's springs begin with the present distances and end with zero length") {
    Sewn sewn;
    REQUIRE(sewn.seam.length.size() == 3);
    std::vector<double> lengths = sewn.model.springs.rest_length;
    const auto rest = [&](int k) { return lengths[sewn.seam.first_spring + k]; };
    struct Moment {
        double time, share;
    };
    for (const auto& [time, share] : {Moment{1.0, 1.0}, {2.0, 1.0}, {2.125, 0.75}, {2.25, 0.5}, {2.5, 0.0}, {9.0, 0.0}}) {
        set_seam_lengths(sewn.seam, time, lengths);
        const double energy = seam_energy(sewn.seam, time, sewn.model, sewn.positions);
        CAPTURE(time);
        CHECK(rest(0) == Approx(0.3 * share).margin(1e-15));
        CHECK(rest(1) == Approx(0.3 * share).margin(1e-15));
        CHECK(rest(2) == Approx(1.0 * share).margin(1e-15));
        const double missing = 1.0 - share;
        CHECK(energy == Approx(0.5 * 40.0 * missing * missing * (0.09 + 0.09 + 1.0)).margin(1e-15));
    }
    CHECK(sewn.seam.closes_after(2.49));
    CHECK_FALSE(sewn.seam.closes_after(2.5));
}

TEST_CASE("A point between two vertices stores the energy of its remaining distance, along it and across") {
    Sewn sewn;
    Seam seam{.length = {}, .from = 0.0, .over = 1.0};
    append_seam(std::vector<Stitch>{{0, 16, 17, 0.25}, {5, 21, 21}}, 40.0, sewn.positions, seam, sewn.model);
    finish_model(sewn.model);
    REQUIRE(sewn.model.sewn_points.size() == 1);
    const double along = 0.25 / 3.0, length = std::hypot(along, 0.3);
    CHECK(seam.length[0] == Approx(length).epsilon(1e-14));
    CHECK(stitch_gap(seam.stitches[0], sewn.positions).norm() == Approx(length).epsilon(1e-14));
    for (const double share : {1.0, 0.5, 0.0}) {
        const double missing = 1.0 - share;
        CHECK(seam_energy(seam, 1.0 - share, sewn.model, sewn.positions) ==
              Approx(0.5 * 40.0 * missing * missing * (length * length + 0.09)).margin(1e-15));
    }
    // 0.1 m off its line it stores that energy, too, whatever its target distance.
    sewn.positions.set(0, sewn.positions.at(0) + Vec3(0.0, 0.0, 0.1));
    CHECK(seam_energy(seam, 0.0, sewn.model, sewn.positions) == Approx(0.5 * 40.0 * 0.01).epsilon(1e-12));
}

TEST_CASE("A point at the end of an edge, or between a vertex and itself, is that vertex") {
    Sewn sewn;
    Seam seam{.length = {}, .from = 0.0, .over = 1.0};
    append_seam(std::vector<Stitch>{{0, 16, 17, 0.0}, {0, 16, 17, 1.0}, {0, 20, 20, 0.5}}, 40.0, sewn.positions, seam,
                sewn.model);
    CHECK(sewn.model.sewn_points.empty());
    const SpringNetwork& network = sewn.model.springs;
    for (int k = 0; k < 3; ++k) {
        CHECK(network.second[seam.first_spring + k] == std::array{16, 17, 20}[k]);
        CHECK(network.stiffness[seam.first_spring + k] == 40.0);
    }
}

TEST_CASE("A new rest length is set at every place where the spring is read, in bands and in slices") {
    for (const SpringLayout layout : {SpringLayout::best, SpringLayout::slices}) {
        ClothModel model = cloth_model(make_grid(1.0, 1.0, 9, 9), sheet_fabric());
        model.adjacency = make_adjacency(model.springs, model.vertex_count(), layout);
        REQUIRE((model.adjacency.bands.count > 0) == (layout == SpringLayout::best));
        for (const int spring : {0, 100, model.springs.size() - 1}) {
            model.springs.rest_length[spring] *= 0.3;
            put_rest_length(model.adjacency, model.springs, spring, model.springs.rest_length[spring],
                            model.adjacency.rest_length);
        }
        CHECK(model.adjacency.rest_length == make_adjacency(model.springs, model.vertex_count(), layout).rest_length);
    }
}

}  // namespace percale::test::seams_test
