#include "tests/support/bench_meshes.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "engine/mesh/topology.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::bench_meshes_test {
namespace {

/// Sets of vertices that are connected by edges.
int pieces(const TriangleMesh& mesh) {
    std::vector<int> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&parent](int i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (const MeshEdge& edge : mesh_edges(mesh.triangles)) parent[root(edge.vertex[0])] = root(edge.vertex[1]);
    std::set<int> roots;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) roots.insert(root(static_cast<int>(i)));
    return static_cast<int>(roots.size());
}

/// Closed loops that border edges form; every vertex of the border is on two border edges exactly where the mesh is a surface.
int border_loops(const TriangleMesh& mesh) {
    std::map<int, std::vector<int>> next;
    for (const MeshEdge& edge : mesh_edges(mesh.triangles)) {
        if (edge.opposite[1] >= 0) continue;
        for (const int side : {0, 1}) next[edge.vertex[side]].push_back(edge.vertex[1 - side]);
    }
    std::set<int> seen;
    int loops = 0;
    for (const auto& [start, neighbours] : next) {
        REQUIRE(neighbours.size() == 2);
        if (seen.contains(start)) continue;
        ++loops;
        for (int at = start; seen.insert(at).second;) at = next[at][seen.contains(next[at][0]) ? 1 : 0];
    }
    return loops;
}

int euler_characteristic(const TriangleMesh& mesh) {
    return static_cast<int>(mesh.vertices.size()) - static_cast<int>(mesh_edges(mesh.triangles).size()) +
           static_cast<int>(mesh.triangles.size());
}

double area(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        sum += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    }
    return sum;
}

/// No directed edge twice: neighbouring triangles face the same side.
bool is_oriented(const TriangleMesh& mesh) {
    std::set<std::pair<int, int>> edges;
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            if (!edges.emplace(t[k], t[(k + 1) % 3]).second) return false;
        }
    }
    return true;
}

/// How many different numbers of neighbours at least one vertex in twenty has.
int valences(const TriangleMesh& mesh) {
    std::vector<int> valence(mesh.vertices.size(), 0);
    for (const MeshEdge& edge : mesh_edges(mesh.triangles)) {
        for (const int i : edge.vertex) ++valence[i];
    }
    std::map<int, std::size_t> found;
    for (const int v : valence) ++found[v];
    return static_cast<int>(
        std::count_if(found.begin(), found.end(), [&](auto pair) { return 20 * pair.second > valence.size(); }));
}

/// Properties common to all three; `loops` open borders, `area` in m^2.
void check_garment(const TriangleMesh& mesh, int wished, int loops) {
    INFO(wished << " vertices wished, " << mesh.vertices.size() << " made");
    CHECK_NOTHROW(check_mesh(mesh, "garment", true));
    CHECK(std::abs(static_cast<double>(mesh.vertices.size()) / wished - 1.0) <= 0.1);
    CHECK(pieces(mesh) == 1);
    CHECK(border_loops(mesh) == loops);
    CHECK(is_oriented(mesh));
    // A sphere with `loops` holes; with border_loops this excludes vertices at which two fans meet.
    CHECK(euler_characteristic(mesh) == 2 - loops);
    CHECK(worst_aspect(mesh) <= 10.0);
    CHECK(valences(mesh) >= 3);
}

constexpr int sizes[] = {1000, 4000, 16000, 65000};

}  // namespace

TEST_CASE("The irregular sheet is one flat square of sound triangles at every size") {
    for (const int wished : sizes) {
        const TriangleMesh mesh = irregular_sheet(1.0, wished);
        check_garment(mesh, wished, 1);
        CHECK(area(mesh) == Approx(1.0).epsilon(1e-12));
        CHECK(mesh.vertices[0] == Vec3(-0.5, 0.0, -0.5));
        CHECK(mesh.vertices[nearest_vertex(mesh, Vec3(0.5, 0.0, -0.5))] == Vec3(0.5, 0.0, -0.5));
        const Triangle& t = mesh.triangles[0];
        const Vec3 normal = (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
        CHECK(normal.y() > 0.0);
    }
}

TEST_CASE("The tube skirt is a cone open at both ends, its triangles facing outwards") {
    const double slant = std::hypot(0.6, 0.25), exact = std::numbers::pi * (0.15 + 0.4) * slant;
    for (const int wished : sizes) {
        const TriangleMesh mesh = tube_skirt(wished);
        check_garment(mesh, wished, 2);
        CHECK(area(mesh) == Approx(exact).epsilon(20.0 / wished));  // chords are shorter than arcs
        for (const Triangle& t : mesh.triangles) {
            const Vec3& a = mesh.vertices[t[0]];
            const Vec3 normal = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
            REQUIRE(normal.dot(Vec3(a.x(), 0.0, a.z())) > 0.0);
        }
    }
}

TEST_CASE("The T-shirt is one surface with openings for the neck, the waist and two arms") {
    for (const int wished : sizes) {
        const TriangleMesh mesh = t_shirt(wished);
        check_garment(mesh, wished, 4);
        CHECK(area(mesh) == Approx(2.0 * (0.5 * 0.45 + 1.1 * 0.25)).epsilon(0.05));
    }
}

TEST_CASE("Meshes for measurements are the same each time they are made") {
    const TriangleMesh once = t_shirt(2000), again = t_shirt(2000);
    CHECK(once.vertices == again.vertices);
    CHECK(once.triangles == again.triangles);
}

TEST_CASE("A shuffled mesh has every triangle in its place, under other numbers that lie far apart") {
    const TriangleMesh mesh = irregular_sheet(1.0, 1000), other = shuffled(mesh);
    const int count = static_cast<int>(mesh.vertices.size());
    REQUIRE(other.vertices.size() == mesh.vertices.size());
    REQUIRE(other.triangles.size() == mesh.triangles.size());
    check_mesh(other, "shuffled", true);  // so every vertex is in use
    double apart = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            CHECK(other.vertices[other.triangles[t][k]] == mesh.vertices[mesh.triangles[t][k]]);
            apart += std::abs(other.triangles[t][k] - other.triangles[t][(k + 1) % 3]);
        }
    }
    // Two random numbers below n differ by n/3 in the mean.
    CHECK(apart / (3.0 * static_cast<double>(mesh.triangles.size())) == Approx(count / 3.0).epsilon(0.1));
    CHECK(shuffled(mesh).triangles == other.triangles);
}

TEST_CASE("A free sheet that hangs from two corners takes a step") {
    const TriangleMesh mesh = irregular_sheet(1.0, 1000);
    Simulation simulation({});
    const ClothId cloth = simulation.add_cloth(mesh, {.springs = {.structural = 1000.0, .bend = 10.0}});
    simulation.pin(cloth, 0);
    simulation.pin(cloth, nearest_vertex(mesh, Vec3(0.5, 0.0, -0.5)));
    CHECK(simulation.step().status == StepStatus::ok);
}

TEST_CASE("The worst aspect of an equilateral triangle is that of its height") {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}, {10, 0, 0}};
    mesh.triangles = {{0, 1, 2}};
    CHECK(worst_aspect(mesh) == Approx(2.0 / std::sqrt(3.0)));
    mesh.triangles.push_back({1, 3, 2});
    CHECK(worst_aspect(mesh) > 9.0);
}

}  // namespace percale::test::bench_meshes_test
