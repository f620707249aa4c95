#include "percale/strain.h"

#include <cmath>
#include <numbers>

#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::strain_test {
namespace {

Rotation turn_about(const Vec3& axis, double angle) {
    const Vec3 v = std::sin(0.5 * angle) * axis.normalized();
    return {std::cos(0.5 * angle), v.x(), v.y(), v.z()};
}

/// x along warp, z along weft, as grids lie; then anywhere.
std::vector<Vec3> deformed(const TriangleMesh& mesh, double warp, double weft, double shear) {
    std::vector<Vec3> places;
    for (const Vec3& x : mesh.vertices) {
        const double across = (1.0 + weft) * x.z();
        places.push_back(Vec3((1.0 + warp) * x.x() + std::sin(shear) * across, 0.0, std::cos(shear) * across));
    }
    return transform({.translation = Vec3(1, 2, 3), .rotation = turn_about(Vec3(1, -2, 0.5), 1.1)}, places);
}

/// The mesh without its rows and columns.
TriangleMesh free_mesh(const TriangleMesh& grid) { return {.vertices = grid.vertices, .triangles = grid.triangles}; }

}  // namespace

TEST_CASE("A sheet stretched and sheared as a whole has exactly those strains in every triangle, wherever it lies") {
    const TriangleMesh grid = make_grid(0.6, 0.4, 5, 4);
    RestShape rest;
    rest.warp = Vec3(3, 0, 0);
    for (const TriangleMesh& mesh : {grid, free_mesh(grid)}) {
        const RestShape& shape = mesh.is_grid() ? RestShape() : rest;
        for (const TriangleStrain& strain : triangle_strains(mesh, shape, deformed(grid, 0.04, -0.02, 0.1))) {
            CHECK(strain.warp == Approx(0.04).margin(1e-13));
            CHECK(strain.weft == Approx(-0.02).margin(1e-13));
            CHECK(std::abs(strain.shear) == Approx(0.1).margin(1e-13));
        }
    }
}

TEST_CASE("Warp across the sheet exchanges the two stretches") {
    const TriangleMesh grid = make_grid(0.6, 0.4, 4, 4);
    RestShape across;
    across.warp = Vec3(0, 0.5, -1);  // its upright part does not count
    for (const TriangleStrain& strain : triangle_strains(free_mesh(grid), across, deformed(grid, 0.04, -0.02, 0.0))) {
        CHECK(strain.warp == Approx(-0.02).margin(1e-13));
        CHECK(strain.weft == Approx(0.04).margin(1e-13));
    }
}

TEST_CASE("Without warp the strains are the principal ones, the same in every frame") {
    const TriangleMesh grid = make_grid(0.6, 0.4, 4, 4);
    const double shear = 0.2;
    for (const TriangleStrain& strain : triangle_strains(free_mesh(grid), {}, deformed(grid, 0.0, 0.0, shear))) {
        // F^T F = [1, sin s; sin s, 1]
        CHECK(strain.warp == Approx(std::sqrt(1.0 + std::sin(shear)) - 1.0).margin(1e-13));
        CHECK(strain.weft == Approx(std::sqrt(1.0 - std::sin(shear)) - 1.0).margin(1e-13));
        CHECK(strain.shear == 0.0);
    }
}

TEST_CASE("Strain refers to the rest shape, whose panels may lie apart and turned") {
    const TriangleMesh grid = make_grid(0.6, 0.4, 4, 3), mesh = free_mesh(grid);
    RestShape rest;
    rest.warp = Vec3::UnitX();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<Vec3, 3>& corners = rest.corners.emplace_back();
        // Twice as long in x, every triangle somewhere else.
        for (int k = 0; k < 3; ++k) {
            const Vec3& x = mesh.vertices[mesh.triangles[t][k]];
            corners[k] = Vec3(2.0 * x.x() + 7.0 * static_cast<double>(t), 0.0, x.z());
        }
    }
    for (const TriangleStrain& strain : triangle_strains(mesh, rest, mesh.vertices)) {
        CHECK(strain.warp == Approx(-0.5).margin(1e-13));
        CHECK(strain.weft == Approx(0.0).margin(1e-13));
    }
}

TEST_CASE("Areas of vertices are those of the lumped masses, for the mesh as it lies") {
    TriangleMesh grid = make_grid(0.4, 0.2, 3, 3);
    for (Vec3& x : grid.vertices) x *= 2.0;
    const std::vector<double> areas = vertex_areas(grid);
    CHECK(areas[4] == Approx(0.08));
    CHECK(areas[0] == Approx(0.02));
    double sum = 0.0;
    for (const double area : vertex_areas(free_mesh(grid))) sum += area;
    CHECK(sum == Approx(0.32));
}

TEST_CASE("A triangle drawn together to a point along warp has no shear") {
    const TriangleMesh mesh = make_grid(1, 1, 2, 2);
    for (const TriangleStrain& strain : triangle_strains(mesh, {}, std::vector<Vec3>(4, Vec3::Zero()))) {
        CHECK(strain.warp == -1.0);
        CHECK(strain.weft == -1.0);
        CHECK(strain.shear == 0.0);
    }
}

TEST_CASE("Strains of another number of positions are refused") {
    const TriangleMesh grid = make_grid(0.6, 0.4, 4, 3);
    CHECK_THROWS_AS(triangle_strains(grid, {}, std::vector<Vec3>(5, Vec3::Zero())), SceneError);
}

}  // namespace percale::test::strain_test
