#include "engine/mesh/lumped_mass.h"

#include <numeric>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::lumped_mass_test {
namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

double area(const TriangleMesh& mesh, const Triangle& t) {
    return 0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm();
}

double area(const TriangleMesh& mesh) {
    double total = 0.0;
    for (const Triangle& t : mesh.triangles) total += area(mesh, t);
    return total;
}

}  // namespace

TEST_CASE("Masses add up to density times area") {
    const TriangleMesh grid = make_grid(1.3, 0.7, 9, 6), sphere = make_sphere(0.5, 3);
    CHECK(sum(lumped_masses(grid, 0.2)) == Approx(0.2 * 1.3 * 0.7).epsilon(1e-14));
    CHECK(sum(lumped_masses(sphere, 0.3)) == Approx(0.3 * area(sphere)).epsilon(1e-13));
}

TEST_CASE("A grid vertex has a quarter of each of its cells") {
    const int columns = 5, rows = 4;
    const std::vector<double> masses = lumped_masses(make_grid(2.0, 1.5, columns, rows), 0.2);
    const double quarter = 0.2 * (2.0 / 4) * (1.5 / 3) / 4.0;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            const int cells = (c == 0 || c == columns - 1 ? 1 : 2) * (r == 0 || r == rows - 1 ? 1 : 2);
            CHECK(masses[r * columns + c] == Approx(cells * quarter).epsilon(1e-13));
        }
    }
}

TEST_CASE("Quarter cells do not depend on how the cells are split, but third triangles do") {
    TriangleMesh grid = make_grid(1.0, 1.0, 3, 3);
    const std::vector<double> quarters = lumped_masses(grid, 1.0);
    CHECK(quarters[1] == Approx(0.125).epsilon(1e-14));
    grid.grid_columns = grid.grid_rows = 0;
    const std::vector<double> thirds = lumped_masses(grid, 1.0);
    CHECK(thirds[1] == Approx(0.125 * 2.0 / 3.0).epsilon(1e-14));  // two triangles; a corner has two too, the centre eight
    CHECK(thirds[0] == Approx(0.25 / 3.0).epsilon(1e-14));
    CHECK(thirds[4] == Approx(1.0 / 3.0).epsilon(1e-14));
}

TEST_CASE("A free vertex has a third of each of its triangles") {
    Random random(3);
    TriangleMesh mesh = make_sphere(0.5, 2);
    for (Vec3& x : mesh.vertices) x += random.point(0.03);
    const std::vector<double> masses = lumped_masses(mesh, 0.4);
    for (int i = 0; i < static_cast<int>(mesh.vertices.size()); ++i) {
        double mass = 0.0;
        for (const Triangle& t : mesh.triangles) {
            if (t[0] == i || t[1] == i || t[2] == i) mass += 0.4 * area(mesh, t) / 3.0;
        }
        CHECK(masses[i] == Approx(mass).epsilon(1e-13));
    }
}

TEST_CASE("Masses of a grid follow its rest shape") {
    TriangleMesh grid = make_grid(1.0, 1.0, 4, 4);
    const double before = sum(lumped_masses(grid, 0.2));
    for (Vec3& x : grid.vertices) x = transform(Pose{.rotation = {0.6, 0.8, 0.0, 0.0}, .scale = 3.0}, x);
    CHECK(sum(lumped_masses(grid, 0.2)) == Approx(9.0 * before).epsilon(1e-13));
}

}  // namespace percale::test::lumped_mass_test
