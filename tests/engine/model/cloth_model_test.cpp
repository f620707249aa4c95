#include "engine/model/cloth_model.h"

#include <numeric>

#include "engine/mesh/lumped_mass.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::cloth_model_test {

TEST_CASE("Two cloths make one system in which nothing joins them") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 4, 3), ball = make_sphere(0.2, 1);
    Fabric second = sheet_fabric();
    second.springs.shear = 0.0;
    second.thickness = 0.002;
    ClothModel model;
    append_cloth(model, grid, sheet_fabric(), "grid");
    append_cloth(model, ball, second, "ball");
    finish_model(model);
    REQUIRE(model.cloths.size() == 2);
    CHECK(model.cloths[1].name == "ball");
    CHECK(model.cloths[1].first == 12);
    CHECK(model.cloths[1].count == 42);
    CHECK(model.vertex_count() == 54);
    for (int k = 0; k < model.springs.size(); ++k) CHECK((model.springs.first[k] < 12) == (model.springs.second[k] < 12));
    for (int i = 0; i < 54; ++i) CHECK(model.thickness[i] == (i < 12 ? 0.005 : 0.002));
    for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) CHECK(model.triangles[grid.triangles.size() + t][k] == ball.triangles[t][k] + 12);
    }
    CHECK(model.adjacency.vertex_count == 54);
}

TEST_CASE("A cloth's range knows its mass") {
    const TriangleMesh grid = make_grid(1.0, 2.0, 4, 3);
    const ClothModel model = cloth_model(grid, sheet_fabric());
    CHECK(model.cloths[0].mass == Approx(0.2 * 2.0).epsilon(1e-13));
    CHECK(model.mass == lumped_masses(grid, 0.2));
}

TEST_CASE("Ordering a free mesh moves masses, rest positions and triangle corners along, and leaves earlier cloth unchanged") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 4, 3), ball = make_sphere(0.2, 2);
    Fabric free = sheet_fabric();
    free.springs.shear = 0.0;
    ClothModel model;
    append_cloth(model, grid, sheet_fabric(), "grid");
    order_last_cloth(model);
    CHECK(model.cloths[0].order.kept());
    CHECK(model.rest == grid.vertices);
    append_cloth(model, ball, free, "ball");
    const ClothModel plain = model;
    order_last_cloth(model);
    const ClothRange& range = model.cloths[1];
    CHECK_FALSE(range.order.kept());
    for (int i = 0; i < range.count; ++i) {
        CHECK(range.user_vertex(range.index_of(i)) == i);
        CHECK(model.rest[range.index_of(i)] == ball.vertices[i]);
        CHECK(model.mass[range.index_of(i)] == plain.mass[12 + i]);
    }
    for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            CHECK(model.triangles[grid.triangles.size() + t][k] == range.index_of(ball.triangles[t][k]));
        }
    }
    for (int i = 0; i < 12; ++i) {
        CHECK(model.rest[i] == grid.vertices[i]);
        CHECK(model.mass[i] == plain.mass[i]);
    }
    for (std::size_t t = 0; t < grid.triangles.size(); ++t) CHECK(model.triangles[t] == grid.triangles[t]);
}

TEST_CASE("A cloth that cannot be simulated is refused by name") {
    ClothModel model;
    Fabric heavy = sheet_fabric();
    heavy.area_density = -1.0;
    CHECK(mentions(scene_error([&] { append_cloth(model, make_grid(1, 1, 3, 3), heavy, "flag"); }),
                   {"flag", "area_density", "-1"}));
    TriangleMesh broken = make_grid(1, 1, 3, 3);
    broken.triangles[3] = broken.triangles[2];
    CHECK(mentions(scene_error([&] { append_cloth(model, broken, sheet_fabric(), "flag"); }), {"flag", "repeats"}));
    CHECK(mentions(scene_error([&] { append_cloth(model, make_sphere(1, 1), sheet_fabric(), "hood"); }), {"hood", "shear"}));
}

TEST_CASE("Points are the positions again") {
    Random random(4);
    const std::vector<Vec3> places = random_points(random, 13, 1.0);
    ClothState state{.positions = to_vec3_arrays(places),
                     .velocities = {},
                     .points = std::vector<Vec3>(13),
                     .stick_anchors = {},
                     .impacts = {},
                     .rest_length = {}};
    update_points(state);
    CHECK(state.points == places);
}

}  // namespace percale::test::cloth_model_test
