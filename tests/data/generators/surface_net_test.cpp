#include "data/generators/surface_net.h"

#include <cmath>

#include "tests/scenes/mesh_laws.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::surface_net_test {
namespace {

double sphere(const Vec3& x) { return x.norm() - 1.0; }
double torus(const Vec3& x) { return std::hypot(std::hypot(x[0], x[2]) - 1.0, x[1]) - 0.4; }

const Box unit_box = {{0, -1.5, -1.5}, {1.5, 1.5, 1.5}};

}  // namespace

TEST_CASE("a sphere becomes a closed surface around its volume, better on finer lattices") {
    double error_before = 1.0;
    for (const double spacing : {0.2, 0.1, 0.05}) {
        const TriangleMesh mesh = mirrored(half_surface_net(sphere, unit_box, spacing));
        CHECK(is_watertight(mesh));
        CHECK(has_single_fans(mesh));
        CHECK(euler_number(mesh) == 2);
        const double error = std::abs(volume(mesh) / (4.0 / 3.0 * M_PI) - 1.0);
        CHECK(error < 0.5 * error_before);
        error_before = error;
    }
    CHECK(error_before < 5e-3);
}

TEST_CASE("every vertex lies within a cell of the surface") {
    const double spacing = 0.07;
    for (const Vec3& x : half_surface_net(sphere, unit_box, spacing).vertices) REQUIRE(std::abs(sphere(x)) < 0.5 * spacing);
}

TEST_CASE("a torus keeps its hole") {
    const TriangleMesh mesh = mirrored(half_surface_net(torus, unit_box, 0.06));
    CHECK(is_watertight(mesh));
    CHECK(euler_number(mesh) == 0);
    CHECK(volume(mesh) == Approx(2.0 * M_PI * M_PI * 0.16).epsilon(0.02));
}

TEST_CASE("the half is open exactly along its seam at x = 0") {
    const TriangleMesh half = half_surface_net(sphere, unit_box, 0.1);
    const EdgeCount edges(half);
    CHECK(edges.oriented());
    int seam_edges = 0;
    for (const auto& [edge, times] : edges.directed) {
        const bool on_seam = half.vertices[edge.first][0] == 0.0 && half.vertices[edge.second][0] == 0.0;
        const bool is_open = edges.count(edge.second, edge.first) == 0;
        REQUIRE(is_open == on_seam);
        seam_edges += is_open ? 1 : 0;
    }
    CHECK(seam_edges > 20);
    for (const Vec3& x : half.vertices) REQUIRE((x[0] == 0.0 || x[0] > 0.0));
}

TEST_CASE("mirroring shares the seam and turns the image's triangles around") {
    const TriangleMesh half = {{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 2, 1}}};
    const TriangleMesh whole = mirrored(half);
    CHECK(whole.vertices == std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}});
    CHECK(whole.triangles == std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}});
    CHECK(EdgeCount(whole).oriented());
}

TEST_CASE("fields that pinch between lattice nodes still give a manifold") {
    // Sheets and tunnels of about a cell: sums of waves in different directions, cut off by a sphere.
    for (int seed = 0; seed < 12; ++seed) {
        const auto field = [seed](const Vec3& x) {
            const double wave = std::cos((9.0 + seed) * x[0]) + std::cos((11.0 - 0.7 * seed) * x[1] + seed) +
                                std::cos((10.0 + 0.3 * seed) * x[2] + 2.0 * seed);
            return std::max(x.norm() - 1.2, 0.3 * wave);
        };
        INFO("seed " << seed);
        const TriangleMesh mesh = mirrored(half_surface_net(field, unit_box, 0.13));
        CHECK(mesh.triangles.size() > 500);
        CHECK(is_watertight(mesh));
        CHECK(has_single_fans(mesh));
        CHECK(volume(mesh) > 0.0);
    }
}

}  // namespace percale::scenes::test::surface_net_test
