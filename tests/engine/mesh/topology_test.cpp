#include "engine/mesh/topology.h"

#include <algorithm>
#include <map>
#include <set>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::topology_test {
namespace {

/// Edge -> opposite vertices, by looking at every triangle for every edge.
std::map<std::pair<int, int>, std::multiset<int>> edges_by_search(const std::vector<Triangle>& triangles) {
    std::map<std::pair<int, int>, std::multiset<int>> edges;
    for (const auto& [a, b, c] : triangles) {
        for (const auto& [i, j, k] : {Triangle{a, b, c}, Triangle{b, c, a}, Triangle{c, a, b}})
            edges[std::minmax(i, j)].insert(k);
    }
    return edges;
}

void check_edges(const std::vector<Triangle>& triangles) {
    const std::vector<MeshEdge> edges = mesh_edges(triangles);
    const auto expected = edges_by_search(triangles);
    REQUIRE(edges.size() == expected.size());
    auto wanted = expected.begin();
    for (const MeshEdge& edge : edges) {  // both in the order of their vertices
        CHECK(std::pair(edge.vertex[0], edge.vertex[1]) == wanted->first);
        std::multiset<int> opposite = {edge.opposite[0]};
        if (edge.opposite[1] >= 0) opposite.insert(edge.opposite[1]);
        CHECK(opposite == wanted->second);
        ++wanted;
    }
}

}  // namespace

TEST_CASE("Mesh edges agree with a search over all triangles") {
    check_edges(make_grid(1.0, 1.0, 7, 5).triangles);
    check_edges(make_sphere(1.0, 2).triangles);
    check_edges({{4, 2, 9}});
    CHECK(mesh_edges({}).empty());
}

TEST_CASE("Mesh edges agree with a search on torn, shuffled meshes") {
    Random random(11);
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<Triangle> kept;
        for (Triangle t : make_sphere(1.0, 2).triangles) {
            std::rotate(t.begin(), t.begin() + random.index(3), t.end());
            if (random.number(0.0, 1.0) < 0.7) kept.insert(kept.begin() + random.index(static_cast<int>(kept.size()) + 1), t);
        }
        check_edges(kept);
    }
}

TEST_CASE("A grid has as many edges as Euler's formula requires") {
    for (const auto& [columns, rows] : {std::pair(2, 2), std::pair(5, 3), std::pair(12, 12)}) {
        const TriangleMesh grid = make_grid(1.0, 1.0, columns, rows);
        CHECK(mesh_edges(grid.triangles).size() == grid.vertices.size() + grid.triangles.size() - 1);
    }
}

TEST_CASE("Every shape but the plane encloses a volume") {
    for (const TriangleMesh& mesh :
         {make_sphere(0.3, 2), make_box({1.0, 2.0, 3.0}), make_cylinder(0.1, 0.5, 12), make_capsule(0.1, 0.4, 12)}) {
        CHECK_NOTHROW(check_encloses(mesh, "shape", "why"));
    }
    TriangleMesh flat = make_sphere(0.3, 1);
    for (Vec3& x : flat.vertices) x.y() = 0.0;
    CHECK_THROWS_WITH(check_encloses(flat, "bag", "why"), "bag: it is flat and encloses nothing; why");
    CHECK_THROWS_WITH(check_encloses(make_plane(1.0), "plane", "why"),
                      "plane: edge (0, 2) belongs to one triangle: the mesh is open there; why");
}

}  // namespace percale::test::topology_test
