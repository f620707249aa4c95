#include "topology.h"

#include <algorithm>
#include <cmath>

#include "percale/error.h"

namespace percale {
namespace {

/// Twice the area over the square of the longest edge. Triangles with less are refused: their height is rounding. Smaller: a
/// triangle without a direction gets into the model. Larger: real needles are refused.
constexpr double min_triangle_area = 1e-12;

/// Volume over area^1.5 of a closed mesh (0.094 for a ball). A mesh with less is flat: its volume is rounding.
constexpr double min_enclosed_ratio = 1e-9;

std::string edge_text(std::array<int, 2> edge) {
    return "edge (" + std::to_string(edge[0]) + ", " + std::to_string(edge[1]) + ")";
}

/// Directed edges of the triangles, sorted.
std::vector<std::array<int, 2>> directed_edges(std::span<const Triangle> triangles) {
    std::vector<std::array<int, 2>> edges;
    for (const auto& [a, b, c] : triangles) edges.insert(edges.end(), {{a, b}, {b, c}, {c, a}});
    std::sort(edges.begin(), edges.end());
    return edges;
}

/// Volume of a closed mesh, m^3; its area, m^2.
struct Extent {
    double volume = 0.0, area = 0.0;
};

Extent extent_of(const TriangleMesh& mesh) {
    Extent extent;
    const Vec3& origin = mesh.vertices.front();
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 x = mesh.vertices[a] - origin, y = mesh.vertices[b] - origin, z = mesh.vertices[c] - origin;
        extent.volume += x.dot(y.cross(z)) / 6.0;
        extent.area += 0.5 * (y - x).cross(z - x).norm();
    }
    return extent;
}

}  // namespace

bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return (b - a).cross(c - a).norm() > min_triangle_area * longest;
}

std::vector<MeshEdge> mesh_edges(std::span<const Triangle> triangles) {
    std::vector<MeshEdge> edges;
    edges.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
            edges.push_back({{low, high}, {t[(k + 2) % 3], -1}});
        }
    }
    std::stable_sort(edges.begin(), edges.end(), [](const MeshEdge& a, const MeshEdge& b) { return a.vertex < b.vertex; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (kept > 0 && edges[kept - 1].vertex == edges[i].vertex) {
            edges[kept - 1].opposite[1] = edges[i].opposite[0];
        } else {
            edges[kept++] = edges[i];
        }
    }
    edges.resize(kept);
    return edges;
}

void check_encloses(const TriangleMesh& mesh, const std::string& name, const std::string& reason) {
    const std::vector<std::array<int, 2>> edges = directed_edges(mesh.triangles);
    for (const std::array<int, 2>& edge : edges) {
        const std::array<int, 2> back = {edge[1], edge[0]};
        if (std::binary_search(edges.begin(), edges.end(), back)) continue;
        const bool twice = std::count(edges.begin(), edges.end(), edge) > 1;
        throw SceneError(name, edge_text(edge) +
                                   (twice ? " has two triangles that are wound against each other; "
                                          : " belongs to one triangle: the mesh is open there; ") +
                                   reason);
    }
    const auto [volume, area] = extent_of(mesh);
    const double min = min_enclosed_ratio * area * std::sqrt(area);
    if (volume > min) return;
    throw SceneError(
        name, (volume < -min ? "its triangles are clockwise seen from outside; " : "it is flat and encloses nothing; ") + reason);
}

}  // namespace percale
