#include "generators/mesh_relax.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace percale::scenes {

namespace {

/// Radians. A flip of an edge has to enlarge the smallest angle by more. 0: flips may go to and fro.
constexpr double min_flip_gain = 1e-6;

/// Cosine of the turn (60 degrees) that a triangle's normal may make by a flip or a merge. Smaller: surfaces fold over.
constexpr double min_normal_cosine = 0.5;

/// Radians (5 degrees). Merging vertices leaves no smaller angle. 0: needles. Larger: short edges stay.
constexpr double min_merged_angle = 5.0 * std::numbers::pi / 180.0;

/// Sweeps over all edges in one call. Fewer: meshes are left with flips to make.
constexpr int max_flip_sweeps = 30;

/// The triangles beside an edge, and how often the edge occurs.
struct EdgeSides {
    std::array<int, 2> triangles = {-1, -1};
    int count = 0;
};
using EdgeMap = std::unordered_map<std::uint64_t, EdgeSides>;

std::uint64_t edge_key(int a, int b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint64_t>(std::max(a, b));
}

EdgeMap edges_of(const TriangleMesh& mesh) {
    EdgeMap edges;
    edges.reserve(mesh.triangles.size() * 2);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& triangle = mesh.triangles[t];
        for (int k = 0; k < 3; ++k) {
            EdgeSides& sides = edges[edge_key(triangle[k], triangle[(k + 1) % 3])];
            if (sides.count < 2) sides.triangles[sides.count] = static_cast<int>(t);
            ++sides.count;
        }
    }
    return edges;
}

Vec3 normal_of(const TriangleMesh& mesh, const Triangle& t) {
    return (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}

double smallest_angle_of(const TriangleMesh& mesh, const Triangle& t) {
    double smallest = std::numbers::pi;
    for (int k = 0; k < 3; ++k) {
        const Vec3 u = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
        const Vec3 v = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
        smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
    return smallest;
}

/// The two triangles that the flip of edge (first[k], first[k+1]) would make of `first` and `second`.
std::array<Triangle, 2> flipped(const Triangle& first, int k, const Triangle& second) {
    const int a = first[k], b = first[(k + 1) % 3], c = first[(k + 2) % 3];
    int d = second[0];
    for (const int vertex : second) d = vertex != a && vertex != b ? vertex : d;
    return {Triangle{c, a, d}, Triangle{d, b, c}};
}

bool worth_flipping(const TriangleMesh& mesh, const std::array<Triangle, 2>& before, const std::array<Triangle, 2>& after) {
    const double gain = std::min(smallest_angle_of(mesh, after[0]), smallest_angle_of(mesh, after[1])) -
                        std::min(smallest_angle_of(mesh, before[0]), smallest_angle_of(mesh, before[1]));
    if (gain < min_flip_gain) return false;
    // Every new normal stays within 60 degrees of both old ones.
    for (const Triangle& now : after)
        for (const Triangle& was : before)
            if (normal_of(mesh, now).normalized().dot(normal_of(mesh, was).normalized()) < min_normal_cosine) return false;
    return true;
}

/// One pass over all edges; each triangle takes part in one flip at most, so that the map stays true where it is used.
int flip_sweep(TriangleMesh& mesh) {
    EdgeMap edges = edges_of(mesh);
    std::vector<bool> touched(mesh.triangles.size(), false);
    int flips = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3 && !touched[t]; ++k) {
            const Triangle triangle = mesh.triangles[t];
            const EdgeSides sides = edges[edge_key(triangle[k], triangle[(k + 1) % 3])];
            const int other = sides.triangles[0] == static_cast<int>(t) ? sides.triangles[1] : sides.triangles[0];
            if (sides.count != 2 || touched[other]) continue;
            const std::array<Triangle, 2> after = flipped(triangle, k, mesh.triangles[other]);
            const std::uint64_t new_edge = edge_key(after[0][0], after[0][2]);
            if (edges.count(new_edge) > 0 || !worth_flipping(mesh, {triangle, mesh.triangles[other]}, after)) continue;
            mesh.triangles[t] = after[0];
            mesh.triangles[other] = after[1];
            touched[t] = touched[other] = true;
            edges[new_edge] = {{static_cast<int>(t), other}, 2};
            ++flips;
        }
    }
    return flips;
}

/// Triangles around every vertex, as long as nothing near it has changed.
std::vector<std::vector<int>> stars_of(const TriangleMesh& mesh) {
    std::vector<std::vector<int>> stars(mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const int v : mesh.triangles[t]) stars[v].push_back(static_cast<int>(t));
    return stars;
}

std::vector<int> neighbours(const TriangleMesh& mesh, const std::vector<int>& star, int vertex) {
    std::vector<int> ring;
    for (const int t : star)
        for (const int v : mesh.triangles[t])
            if (v != vertex) ring.push_back(v);
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    return ring;
}

bool contains(const Triangle& t, int vertex) { return t[0] == vertex || t[1] == vertex || t[2] == vertex; }

/// Whether the triangles of `star` without `kept` survive the move of `gone` to `kept`.
bool star_survives(const TriangleMesh& mesh, const std::vector<int>& star, int gone, int kept) {
    for (const int t : star) {
        const Triangle& before = mesh.triangles[t];
        if (contains(before, kept)) continue;
        Triangle after = before;
        std::replace(after.begin(), after.end(), gone, kept);
        if (smallest_angle_of(mesh, after) < min_merged_angle) return false;
        if (normal_of(mesh, after).normalized().dot(normal_of(mesh, before).normalized()) < min_normal_cosine) return false;
    }
    return true;
}

/// Merging keeps the topology where the two ends have exactly the edge's two opposite vertices as common neighbours, and these
/// lose one of four triangles or more.
bool may_merge(const TriangleMesh& mesh, const std::vector<std::vector<int>>& stars, int gone, int kept) {
    const std::vector<int> a = neighbours(mesh, stars[gone], gone), b = neighbours(mesh, stars[kept], kept);
    std::vector<int> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    if (common.size() != 2 || stars[common[0]].size() < 4 || stars[common[1]].size() < 4) return false;
    return star_survives(mesh, stars[gone], gone, kept);
}

/// Removes triangles with two equal corners and vertices marked as gone.
void compact(TriangleMesh& mesh, const std::vector<bool>& gone) {
    std::vector<int> number(mesh.vertices.size(), -1);
    std::vector<Vec3> vertices;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (gone[v]) continue;
        number[v] = static_cast<int>(vertices.size());
        vertices.push_back(mesh.vertices[v]);
    }
    std::vector<Triangle> triangles;
    for (const Triangle& t : mesh.triangles)
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    mesh.vertices = std::move(vertices);
    mesh.triangles = std::move(triangles);
}

}  // namespace

int flip_edges(TriangleMesh& mesh) {
    int total = 0, flips = 1;
    for (int sweep = 0; sweep < max_flip_sweeps && flips > 0; ++sweep) total += flips = flip_sweep(mesh);
    return total;
}

int collapse_short_edges(TriangleMesh& mesh, double length) {
    const std::vector<std::vector<int>> stars = stars_of(mesh);
    const std::vector<bool> boundary = boundary_vertices(mesh);
    std::vector<bool> gone(mesh.vertices.size(), false), touched(mesh.vertices.size(), false);
    int merges = 0;
    const auto try_merge = [&](int a, int b) {
        if (touched[a] || touched[b] || (mesh.vertices[a] - mesh.vertices[b]).norm() >= length) return;
        if (boundary[a]) std::swap(a, b);
        if (boundary[a] || !may_merge(mesh, stars, a, b)) return;
        for (const int end : {a, b})
            for (const int v : neighbours(mesh, stars[end], end)) touched[v] = true;
        for (const int t : stars[a]) std::replace(mesh.triangles[t].begin(), mesh.triangles[t].end(), a, b);
        gone[a] = true;
        ++merges;
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const Triangle triangle = mesh.triangles[t];
            try_merge(triangle[k], triangle[(k + 1) % 3]);
        }
    compact(mesh, gone);
    return merges;
}

void smooth(TriangleMesh& mesh, const Projection& project) {
    std::vector<Vec3> sum(mesh.vertices.size(), Vec3::Zero());
    std::vector<int> count(mesh.vertices.size(), 0);
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            sum[t[k]] += mesh.vertices[t[(k + 1) % 3]] + mesh.vertices[t[(k + 2) % 3]];
            count[t[k]] += 2;
        }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        if (count[v] > 0) mesh.vertices[v] = project(v, 0.5 * (mesh.vertices[v] + sum[v] / count[v]));
}

void relax(TriangleMesh& mesh, int rounds, const Projection& project) {
    for (int round = 0; round < rounds; ++round) {
        smooth(mesh, project);
        flip_edges(mesh);
    }
}

std::vector<bool> boundary_vertices(const TriangleMesh& mesh) {
    const EdgeMap edges = edges_of(mesh);
    std::vector<bool> boundary(mesh.vertices.size(), false);
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            if (edges.at(edge_key(t[k], t[(k + 1) % 3])).count == 1) boundary[t[k]] = boundary[t[(k + 1) % 3]] = true;
    return boundary;
}

double smallest_angle(const TriangleMesh& mesh) {
    double smallest = std::numbers::pi;
    for (const Triangle& t : mesh.triangles) smallest = std::min(smallest, smallest_angle_of(mesh, t));
    return smallest * 180.0 / std::numbers::pi;
}

}  // namespace percale::scenes
