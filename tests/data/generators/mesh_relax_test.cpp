#include "data/generators/mesh_relax.h"

#include <random>

#include "tests/scenes/mesh_laws.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::mesh_relax_test {
namespace {

/// A flat grid whose inner vertices are shaken by up to a fraction of its cells.
TriangleMesh shaken_grid(int vertices, double share) {
    TriangleMesh mesh = make_grid(1.0, 1.0, vertices, vertices);
    std::mt19937_64 random(11);
    const std::vector<bool> boundary = boundary_vertices(mesh);
    std::uniform_real_distribution<double> shake(-share / (vertices - 1), share / (vertices - 1));
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (boundary[v]) continue;
        const double z = shake(random), x = shake(random);  // drawn in an order that the language fixes
        mesh.vertices[v] += Vec3(x, 0.0, z);
    }
    return mesh;
}

/// Whether no triangle of a flat mesh is turned over.
bool all_upward(const TriangleMesh& mesh) {
    for (const Triangle& t : mesh.triangles) {
        const Vec3 u = mesh.vertices[t[1]] - mesh.vertices[t[0]], v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
        if (u.cross(v)[1] <= 0.0) return false;
    }
    return true;
}

const TriangleMesh flat_kite = {{{0, 0, 0}, {1, 0, 0.1}, {2, 0, 0}, {1, 0, -0.1}}, {{0, 1, 2}, {0, 2, 3}}};

}  // namespace

TEST_CASE("the long diagonal of a kite is flipped to the short one") {
    TriangleMesh mesh = flat_kite;
    CHECK(flip_edges(mesh) == 1);
    REQUIRE(mesh.triangles.size() == 2);
    for (const Triangle& t : mesh.triangles) {
        CHECK(std::count(t.begin(), t.end(), 1) == 1);
        CHECK(std::count(t.begin(), t.end(), 3) == 1);
    }
    CHECK(all_upward(mesh));
    CHECK(flip_edges(mesh) == 0);
}

TEST_CASE("a kite that is folded sharply or not convex keeps its diagonal") {
    TriangleMesh folded = flat_kite;
    folded.vertices[1] = {1, 0.08, -0.06};  // back over the other triangle
    CHECK(flip_edges(folded) == 0);
    TriangleMesh dart = flat_kite;
    dart.vertices[0] = {1, 0, 0.02};
    dart.vertices[2] = {3, 0, 0};
    dart.triangles = {{0, 1, 2}, {0, 2, 3}};
    CHECK(flip_edges(dart) == 0);
}

TEST_CASE("flips raise the smallest angle and keep area, boundary and topology") {
    TriangleMesh mesh = shaken_grid(20, 0.3);
    const double angle = smallest_angle(mesh);
    const std::vector<Vec3> vertices = mesh.vertices;
    const std::vector<bool> boundary = boundary_vertices(mesh);
    CHECK(flip_edges(mesh) > 10);
    CHECK(smallest_angle(mesh) >= angle);
    CHECK(mesh.vertices == vertices);
    CHECK(boundary_vertices(mesh) == boundary);
    CHECK(area(mesh) == Approx(1.0).epsilon(1e-12));
    CHECK(all_upward(mesh));
    CHECK(EdgeCount(mesh).oriented());
    CHECK(euler_number(mesh) == 1);
}

TEST_CASE("a tetrahedron has no edge that could be flipped or merged") {
    TriangleMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    CHECK(flip_edges(mesh) == 0);
    CHECK(collapse_short_edges(mesh, 100.0) == 0);
    CHECK(mesh.triangles.size() == 4);
}

TEST_CASE("smoothing moves a vertex half way to the mean of its neighbours, then asks where it belongs") {
    TriangleMesh mesh = make_grid(2.0, 2.0, 3, 3);
    mesh.vertices[4] = {0.4, 0.8, -0.2};
    std::size_t asked = 0;
    smooth(mesh, [&](std::size_t v, const Vec3& moved) {
        ++asked;
        return v == 4 ? Vec3(moved[0], moved[1], 7.0) : mesh.vertices[v];
    });
    CHECK(asked == 9);
    CHECK((mesh.vertices[4] - Vec3(0.2, 0.4, 7.0)).norm() < 1e-15);
    CHECK(mesh.vertices[0] == Vec3(-1, 0, -1));
}

TEST_CASE("short inner edges are merged without holes, folds or a moved boundary") {
    TriangleMesh mesh = shaken_grid(30, 0.24);
    REQUIRE(all_upward(mesh));
    const std::size_t vertices = mesh.vertices.size();
    std::vector<Vec3> rim;
    std::vector<bool> boundary = boundary_vertices(mesh);
    for (std::size_t v = 0; v < vertices; ++v)
        if (boundary[v]) rim.push_back(mesh.vertices[v]);
    const int merges = collapse_short_edges(mesh, 0.8 / 29.0);
    CHECK(merges > 10);
    CHECK(mesh.vertices.size() == vertices - merges);
    CHECK(mesh.triangles.size() == 2 * 29 * 29 - 2 * static_cast<std::size_t>(merges));
    std::vector<Vec3> rim_now;
    boundary = boundary_vertices(mesh);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        if (boundary[v]) rim_now.push_back(mesh.vertices[v]);
    CHECK(rim_now == rim);
    CHECK(area(mesh) == Approx(1.0).epsilon(1e-12));
    CHECK(all_upward(mesh));
    CHECK(EdgeCount(mesh).oriented());
    CHECK(has_single_fans(mesh));
    CHECK(euler_number(mesh) == 1);
}

TEST_CASE("rounds of relaxing turn a shaken grid into well-shaped triangles") {
    TriangleMesh mesh = shaken_grid(20, 0.45);
    REQUIRE(smallest_angle(mesh) < 15.0);
    const std::vector<bool> boundary = boundary_vertices(mesh);
    relax(mesh, 20, [&](std::size_t v, const Vec3& moved) { return boundary[v] ? mesh.vertices[v] : moved; });
    CHECK(smallest_angle(mesh) > 30.0);
    CHECK(area(mesh) == Approx(1.0).epsilon(1e-12));
    CHECK(all_upward(mesh));
}

TEST_CASE("the smallest angle of known triangles") {
    const double root3 = std::sqrt(3.0);
    CHECK(smallest_angle({{{0, 0, 0}, {2, 0, 0}, {1, root3, 0}}, {{0, 1, 2}}}) == Approx(60.0));
    CHECK(smallest_angle({{{0, 0, 0}, {1, 0, 0}, {0, root3, 0}}, {{0, 1, 2}}}) == Approx(30.0));
    CHECK(smallest_angle({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}) == 0.0);
    const TriangleMesh mesh = shaken_grid(10, 0.4);
    CHECK(smallest_angle(mesh) == Approx(sharpest_angle(mesh)));
}

TEST_CASE("the boundary of a grid is its rim, a sphere has none") {
    const std::vector<bool> rim = boundary_vertices(make_grid(1.0, 1.0, 4, 3));
    CHECK(rim == std::vector<bool>{true, true, true, true, true, false, false, true, true, true, true, true});
    const std::vector<bool> none = boundary_vertices(make_sphere(1.0, 1));
    CHECK(std::count(none.begin(), none.end(), true) == 0);
}

}  // namespace percale::scenes::test::mesh_relax_test
