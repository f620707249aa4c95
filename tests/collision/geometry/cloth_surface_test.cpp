#include "collision/geometry/cloth_surface.h"

#include <algorithm>
#include <set>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::cloth_surface_test {

TEST_CASE("edges of a cloth surface know their triangles and the vertices opposite") {
    const TriangleMesh mesh = GENERATE(make_grid(1, 1, 7, 5), make_sphere(1.0, 2), joined(make_grid(1, 1, 2, 2), soup(3, 1)));
    const ClothSurface surface = make_cloth_surface(mesh.triangles, mesh.vertices.size());
    std::size_t uses = 0;
    for (std::size_t e = 0; e < surface.edges.size(); ++e) {
        const ClothSurface::Edge& edge = surface.edges[e];
        CHECK(edge.vertex[0] < edge.vertex[1]);
        CHECK(surface.edge_between(edge.vertex[1], edge.vertex[0]) == static_cast<int>(e));
        for (int side = 0; side < 2; ++side) {
            if (edge.triangle[side] < 0) continue;
            ++uses;
            std::set<int> corners(mesh.triangles[edge.triangle[side]].begin(), mesh.triangles[edge.triangle[side]].end());
            CHECK(corners == std::set<int>{edge.vertex[0], edge.vertex[1], edge.opposite[side]});
        }
        CHECK((edge.triangle[1] < 0 || edge.triangle[0] < edge.triangle[1]));
    }
    CHECK(uses == 3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            CHECK(surface.triangle_edges[t][k] == surface.edge_between(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]));
        }
    }
}

TEST_CASE("a vertex of a cloth surface has its neighbours around it and the lowest triangle as owner") {
    const TriangleMesh mesh = make_grid(1, 1, 6, 4);
    const ClothSurface surface = make_cloth_surface(mesh.triangles, mesh.vertices.size() + 1);
    for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
        std::set<int> ring;
        int owner = -1;
        for (int t = static_cast<int>(mesh.triangles.size()) - 1; t >= 0; --t) {
            const Triangle& corners = mesh.triangles[t];
            if (std::find(corners.begin(), corners.end(), v) == corners.end()) continue;
            owner = t;
            ring.insert(corners.begin(), corners.end());
        }
        ring.erase(v);
        const std::span<const int> found = surface.neighbours(v);
        CHECK(std::set<int>(found.begin(), found.end()) == ring);
        CHECK(found.size() == ring.size());
        const std::span<const int> edges = surface.edges_at(v);
        REQUIRE(edges.size() == found.size());
        for (std::size_t k = 0; k < edges.size(); ++k) CHECK(edges[k] == surface.edge_between(v, found[k]));
        CHECK(surface.vertex_owner[v] == owner);
    }
    CHECK(surface.neighbours(static_cast<int>(mesh.vertices.size())).empty());
    CHECK(surface.vertex_owner.back() == -1);
}

}  // namespace percale::test::cloth_surface_test
