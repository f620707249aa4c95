#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "percale/error.h"
#include "percale/mesh.h"
#include "topology.h"

namespace percale {
namespace {

std::string triangle_text(int index, const Triangle& t) {
    return "triangle " + std::to_string(index) + " (" + std::to_string(t[0]) + ", " + std::to_string(t[1]) + ", " +
           std::to_string(t[2]) + ")";
}

void check_vertices(const TriangleMesh& mesh, const std::string& name) {
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (mesh.vertices[i].allFinite()) continue;
        throw SceneError(name, "vertex " + std::to_string(i) + " is not finite");
    }
}

void check_indices(const TriangleMesh& mesh, const std::string& name) {
    const int count = static_cast<int>(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const int vertex : mesh.triangles[i]) {
            if (vertex >= 0 && vertex < count) continue;
            throw SceneError(name, triangle_text(static_cast<int>(i), mesh.triangles[i]) + " uses vertex " +
                                       std::to_string(vertex) + ", allowed are 0 ... " + std::to_string(count - 1));
        }
    }
}

void check_triangles(const TriangleMesh& mesh, const std::string& name) {
    std::map<Triangle, int> seen;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const int index = static_cast<int>(i);
        Triangle sorted = mesh.triangles[i];
        std::sort(sorted.begin(), sorted.end());
        const auto [entry, added] = seen.try_emplace(sorted, index);
        if (!added) {
            throw SceneError(name,
                             triangle_text(index, mesh.triangles[i]) + " repeats triangle " + std::to_string(entry->second));
        }
        const auto [a, b, c] = mesh.triangles[i];
        if (!has_area(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])) {
            throw SceneError(name, triangle_text(index, mesh.triangles[i]) + " has no area");
        }
    }
}

void check_edges(const TriangleMesh& mesh, const std::string& name) {
    std::map<std::pair<int, int>, int> uses;
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const auto edge = std::minmax(t[k], t[(k + 1) % 3]);
            if (++uses[edge] < 3) continue;
            throw SceneError(name, "edge (" + std::to_string(edge.first) + ", " + std::to_string(edge.second) +
                                       ") belongs to more than two triangles (non-manifold); split the mesh there");
        }
    }
}

void check_used(const TriangleMesh& mesh, const std::string& name) {
    std::vector<bool> used(mesh.vertices.size(), false);
    for (const Triangle& t : mesh.triangles) {
        for (const int vertex : t) used[vertex] = true;
    }
    const auto unused = std::find(used.begin(), used.end(), false);
    if (unused == used.end()) return;
    throw SceneError(name, "vertex " + std::to_string(unused - used.begin()) + " belongs to no triangle, so it has no mass");
}

}  // namespace

void check_mesh(const TriangleMesh& mesh, const std::string& name, bool for_cloth) {
    if (mesh.triangles.empty()) throw SceneError(name, "the mesh has no triangles");
    check_vertices(mesh, name);
    check_indices(mesh, name);
    if (!for_cloth) return;
    check_triangles(mesh, name);
    check_edges(mesh, name);
    check_used(mesh, name);
    const long grid = static_cast<long>(mesh.grid_columns) * mesh.grid_rows;
    if (mesh.is_grid() && grid != static_cast<long>(mesh.vertices.size())) {
        throw SceneError(
            name, "says it is a grid of " + std::to_string(grid) + " vertices, but has " + std::to_string(mesh.vertices.size()));
    }
}

}  // namespace percale
