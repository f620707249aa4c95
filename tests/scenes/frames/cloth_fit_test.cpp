#include "scenes/frames/cloth_fit.h"

#include <cmath>
#include <limits>

#include "tests/support/catch.h"

namespace percale::scenes::test::cloth_fit_test {
namespace {

/// A grid of 2 x 2 cells, each of 0.01 m^2, and what it became.
struct Dressed {
    TriangleMesh start = make_grid(0.2, 0.2, 3, 3), now = start;
    RestShape rest = {};
    std::vector<ContactLoad> loads = {};
    std::vector<TriangleMesh> obstacles = {};

    MeshFields fields(const std::vector<std::string>& words) const {
        return fit_fields({.start = start, .rest = rest, .now = now, .loads = loads, .obstacles = obstacles}, words);
    }
};

}  // namespace

TEST_CASE("the strain of cloth drawn out evenly is the same in triangles and vertices") {
    Dressed cloth;
    for (Vec3& x : cloth.now.vertices) x = Vec3(1.1 * x.x(), 0.0, 0.98 * x.z());
    const MeshFields fields = cloth.fields({"strain"});
    REQUIRE(fields.triangle.size() == 3);
    REQUIRE(fields.vertex.size() == 3);
    const double expected[] = {0.1, -0.02, 0.0};
    for (int k = 0; k < 3; ++k) {
        CHECK(fields.vertex[k].name == fields.triangle[k].name);
        for (const auto* field : {&fields.vertex[k], &fields.triangle[k]}) {
            for (const double value : field->values) CHECK(value == Approx(expected[k]).margin(1e-12));
        }
    }
}

TEST_CASE("pressure is what pushes a vertex off over its area, without friction") {
    Dressed cloth;
    // The middle vertex has a quarter of each cell of 0.01 m^2; of a free mesh a third of each of its 8 triangles.
    cloth.loads = {{.vertex = 4, .obstacle = 0, .normal = {0, 0.3, 0}, .friction = {5, 0, 0}},
                   {.vertex = 4, .obstacle = 1, .normal = {0, -0.1, 0}, .friction = {0, 0, 0}}};
    const std::vector<double> pressure = contact_pressure(cloth.now, cloth.loads);
    CHECK(pressure[4] == Approx(0.4 / 0.01));
    TriangleMesh free = cloth.now;
    free.grid_columns = free.grid_rows = 0;
    CHECK(contact_pressure(free, cloth.loads)[4] == Approx(0.4 / (8 * 0.005 / 3)));
    for (const int v : {0, 1, 2, 3, 5, 6, 7, 8}) CHECK(pressure[v] == 0.0);
    // Pressure times area is the force, whatever the mesh.
    for (Vec3& x : cloth.now.vertices) x *= 3.0;
    CHECK(contact_pressure(cloth.now, cloth.loads)[4] == Approx(pressure[4] / 9.0));
}

TEST_CASE("distance is that to the nearest obstacle, negative inside, infinite without") {
    Dressed cloth;
    CHECK(cloth.fields({"distance"}).vertex[0].values[4] == std::numeric_limits<double>::infinity());
    cloth.obstacles = {make_box({1, 0.1, 1})};
    for (Vec3& x : cloth.obstacles[0].vertices) x.y() -= 0.07;  // its top at -0.02
    CHECK(cloth.fields({"distance"}).vertex[0].values[4] == Approx(0.02));
    cloth.obstacles.push_back(make_sphere(0.05, 4));
    const MeshFields fields = cloth.fields({"distance"});
    CHECK(fields.vertex[0].values[4] == Approx(-0.05).epsilon(0.01));
    CHECK(fields.vertex[0].values[0] == Approx(0.02));
}

TEST_CASE("fields come in the order of their words, and only those") {
    const MeshFields fields = Dressed().fields({"pressure", "strain"});
    REQUIRE(fields.vertex.size() == 4);
    CHECK(fields.vertex[0].name == "pressure");
    CHECK(fields.vertex[1].name == "strain_warp");
    for (const std::string_view word : fit_words) CHECK(fit_words_meaning().find(std::string(word) + ": ") != std::string::npos);
}

TEST_CASE("a spread holds the ends, the middle and what 95 of 100 values do not exceed") {
    std::vector<double> values;
    for (int k = 100; k >= 0; --k) values.push_back(k);
    const Spread spread = spread_of(values);
    CHECK(spread.smallest == 0.0);
    CHECK(spread.median == 50.0);
    CHECK(spread.of_95_percent == 95.0);
    CHECK(spread.largest == 100.0);
    CHECK(spread_of({3.0}).median == 3.0);
}

}  // namespace percale::scenes::test::cloth_fit_test
