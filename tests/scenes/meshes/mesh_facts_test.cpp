#include "meshes/mesh_facts.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "percale/error.h"
#include "tests/scenes/faulty_meshes.h"
#include "tests/support/catch.h"
#include "tests/support/random.h"

namespace percale::scenes::test::mesh_facts_test {
namespace {

/// Triangles with distinct corners between few vertices at random places, some of them the same.
TriangleMesh soup(unsigned seed, int vertices, int triangles) {
    std::mt19937 random(seed);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    TriangleMesh mesh;
    for (int i = 0; i < vertices; ++i) {
        const int x = below(3), y = below(3), z = below(3);
        mesh.vertices.emplace_back(x, y, z);
    }
    while (static_cast<int>(mesh.triangles.size()) < triangles) {
        const int a = below(vertices), b = below(vertices), c = below(vertices);
        if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
    }
    return mesh;
}

using Senses = std::map<VertexPair, std::vector<bool>>;

Senses senses_of(const TriangleMesh& mesh) {
    Senses senses;
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            senses[{std::min(a, b), std::max(a, b)}].push_back(a < b);
        }
    return senses;
}

template <class Wanted>
std::vector<VertexPair> edges_where(const Senses& senses, Wanted wanted) {
    std::vector<VertexPair> result;
    for (const auto& [edge, uses] : senses)
        if (wanted(uses)) result.push_back(edge);
    return result;
}

bool share_an_edge_at(const Triangle& a, const Triangle& b, int vertex) {
    return std::any_of(a.begin(), a.end(), [&](int v) { return v != vertex && std::find(b.begin(), b.end(), v) != b.end(); });
}

/// Walks over the triangles of a vertex from the first of them.
bool is_pinched(const TriangleMesh& mesh, int vertex) {
    std::vector<Triangle> around;
    for (const Triangle& t : mesh.triangles)
        if (std::find(t.begin(), t.end(), vertex) != t.end()) around.push_back(t);
    std::set<std::size_t> reached;
    std::vector<std::size_t> waiting;
    if (!around.empty()) waiting.push_back(0);
    while (!waiting.empty()) {
        const std::size_t now = waiting.back();
        waiting.pop_back();
        if (!reached.insert(now).second) continue;
        for (std::size_t i = 0; i < around.size(); ++i)
            if (share_an_edge_at(around[now], around[i], vertex)) waiting.push_back(i);
    }
    return reached.size() < around.size();
}

}  // namespace

TEST_CASE("edges, vertices and repeats of random triangles are those of a search over all") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const TriangleMesh mesh = soup(seed, 12, 6 + static_cast<int>(seed));
        const MeshFacts facts = mesh_facts(mesh);
        const Senses senses = senses_of(mesh);
        CHECK(facts.open_edges == edges_where(senses, [](const auto& uses) { return uses.size() == 1; }));
        CHECK(facts.crowded_edges == edges_where(senses, [](const auto& uses) { return uses.size() > 2; }));
        CHECK(facts.contrary_edges ==
              edges_where(senses, [](const auto& uses) { return uses.size() == 2 && uses[0] == uses[1]; }));
        std::vector<int> pinched, repeated_places;
        for (int v = 0; v < 12; ++v) {
            if (is_pinched(mesh, v)) pinched.push_back(v);
            const auto same = std::find(mesh.vertices.begin(), mesh.vertices.end(), mesh.vertices[v]);
            if (same - mesh.vertices.begin() < v) repeated_places.push_back(v);
        }
        CHECK(facts.pinched_vertices == pinched);
        CHECK(facts.repeated_places == repeated_places);
    }
}

TEST_CASE("cloth is refused exactly where the facts name a fault that refuses it") {
    int refused = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        const TriangleMesh mesh = soup(seed, 9, 2 + static_cast<int>(seed % 5));
        const MeshFacts facts = mesh_facts(mesh);
        const bool faulty = !facts.unused_vertices.empty() || !facts.repeated_triangles.empty() ||
                            !facts.flat_triangles.empty() || !facts.crowded_edges.empty();
        bool thrown = false;
        try {
            check_mesh(mesh, "soup", true);
        } catch (const SceneError&) {
            thrown = true;
        }
        CHECK(thrown == faulty);
        refused += thrown;
    }
    CHECK(refused > 5);
    CHECK_NOTHROW(check_mesh(make_grid(1, 1, 4, 5), "grid", true));
}

TEST_CASE("shapes are watertight, in one part, right side out, grids have a boundary") {
    for (const TriangleMesh& mesh : {make_sphere(1.0, 2), make_box({1, 2, 3}), make_cylinder(0.1, 1.0, 12)}) {
        const MeshFacts facts = mesh_facts(mesh);
        CHECK(facts.watertight());
        CHECK(facts.parts == 1);
        CHECK(facts.inverted_parts.empty());
        CHECK(facts.pinched_vertices.empty());
    }
    const MeshFacts grid = mesh_facts(make_grid(1.0, 2.0, 3, 5));
    CHECK(grid.open_edges.size() == 2 * (2 + 4));
    CHECK(grid.shortest_edge == Approx(0.5));
    CHECK(grid.longest_edge == Approx(std::sqrt(0.5)));
    CHECK(grid.extent() == Approx(2.0));
    CHECK(grid.farthest() == Approx(1.0));
}

TEST_CASE("a part turned inside out is distinguished from a cavity and from an open one") {
    const TriangleMesh ball = make_sphere(1.0, 1);
    CHECK(mesh_facts(turned(ball)).inverted_parts == std::vector<int>{0});
    const TriangleMesh shell = both(ball, turned(make_sphere(0.5, 1)));
    CHECK(mesh_facts(shell).inverted_parts.empty());
    CHECK(mesh_facts(shell).parts == 2);
    const TriangleMesh apart = both(ball, shifted(turned(make_sphere(0.5, 1)), {3, 0, 0}));
    CHECK(mesh_facts(apart).inverted_parts == std::vector<int>{static_cast<int>(ball.vertices.size())});
    TriangleMesh open = turned(ball);
    open.triangles.pop_back();
    CHECK(mesh_facts(open).inverted_parts.empty());
}

TEST_CASE("slivers are distinguished from flat triangles by their height") {
    const auto triangle = [](double height) {
        return mesh_facts({.vertices = {{0, 0, 0}, {1, 0, 0}, {0.3, height, 0}}, .triangles = {{0, 1, 2}}});
    };
    CHECK(triangle(0.02).slivers.empty());
    CHECK(triangle(0.005).slivers == std::vector<int>{0});
    CHECK(triangle(1e-9).slivers == std::vector<int>{0});
    CHECK(triangle(0.0).slivers.empty());
    CHECK(triangle(0.0).flat_triangles == std::vector<int>{0});
}

TEST_CASE("a mesh joined by place has the triangles that are left, with their numbers") {
    const TriangleMesh ball = make_sphere(1.0, 1);
    TriangleMesh mesh = split_corners(ball);
    CHECK_FALSE(mesh_facts(mesh).watertight());
    CHECK(mesh_facts(joined_by_place(mesh).mesh).watertight());
    mesh.triangles.insert(mesh.triangles.begin() + 3, mesh.triangles[0]);
    mesh.triangles.insert(mesh.triangles.begin() + 5, {0, 0, 1});
    const JoinedMesh joined = joined_by_place(mesh);
    CHECK(mesh_facts(joined.mesh).watertight());
    REQUIRE(joined.number.size() == ball.triangles.size());
    CHECK(joined.number[2] == 2);
    CHECK(joined.number[3] == 4);
    CHECK(joined.number[4] == 6);
}

TEST_CASE("watertight is what it is among the facts") {
    for (unsigned seed = 0; seed < 200; ++seed) {
        const TriangleMesh mesh = soup(seed, 5, 1 + static_cast<int>(seed % 8));
        if (scenes::is_watertight(mesh) != mesh_facts(mesh).watertight()) FAIL_CHECK("seed " << seed);
    }
    CHECK(scenes::is_watertight(make_sphere(1.0, 2)));
    CHECK_FALSE(scenes::is_watertight(free_sheet()));
    CHECK_FALSE(scenes::is_watertight(turned(both(free_sheet(), make_sphere(1.0, 1)))));
}

TEST_CASE("rims that are near each other are those that every pair of vertices says") {
    TriangleMesh other = shifted(free_sheet(), {0.602, 0, 0});  // 2 mm beside the first along one side
    const TriangleMesh two = both(free_sheet(), other);
    const auto near = [](const TriangleMesh& mesh, double distance) {
        return near_rims(mesh, mesh_facts(mesh), distance).vertices;
    };
    CHECK(near(two, 0.001).empty());
    percale::test::Random random(3);
    TriangleMesh rough = two;  // every pair of vertices of the rims, in its cells and beyond
    for (Vec3& x : rough.vertices) x += random.point(0.002);
    const MeshFacts facts = mesh_facts(rough);
    std::set<int> rim, wanted;
    for (const VertexPair& edge : facts.open_edges) rim.insert(edge.begin(), edge.end());
    for (const int a : rim) {
        for (const int b : rim) {  // edges are 0.09 m and more
            const double apart = (rough.vertices[a] - rough.vertices[b]).norm();
            if (a != b && apart < 0.004) wanted.insert(a);
        }
    }
    CHECK(wanted.size() > 3);
    CHECK(near_rims(rough, facts, 0.004).vertices == std::vector<int>(wanted.begin(), wanted.end()));
    CHECK(near_rims(rough, facts, 0.004).widest < 0.004);
    CHECK(near_rims(two, mesh_facts(two), 0.003).widest == Approx(0.002));
    const std::vector<int> found = near(two, 0.003);
    CHECK(found.size() == 14);
    for (const int v : found) CHECK(std::abs(std::abs(two.vertices[v].x() - 0.301) - 0.001) < 1e-9);
    CHECK(near(free_sheet(), 0.09).empty());
    CHECK(near(free_sheet(), 0.15).empty());                      // nor across a corner, where no edge is
    CHECK(near(both(free_sheet(), free_sheet()), 0.05).empty());  // in one place is another finding
    CHECK(near(both(free_sheet(), shifted(free_sheet(), {0, 2e-4, 0})), 1e-3).size() == 48);  // all of both rims
}

}  // namespace percale::scenes::test::mesh_facts_test
