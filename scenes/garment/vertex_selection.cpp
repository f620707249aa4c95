#include "garment/vertex_selection.h"

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "common/bounds.h"
#include "common/text.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// Fraction of a cloth's bounding box, by which the box of a selection grows. 0: vertices on its rim are selected by chance.
constexpr double box_rounding = 1e-9;

std::vector<int> sorted_once(std::vector<int> vertices) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

std::vector<int> selected(const VertexIndices& indices, const TriangleMesh& mesh) {
    const int count = static_cast<int>(mesh.vertices.size());
    std::vector<std::string> missing;
    for (const int vertex : indices.vertices) {
        if (vertex < 0 || vertex >= count) missing.push_back(std::to_string(vertex));
    }
    if (missing.empty()) return sorted_once(indices.vertices);
    const std::size_t reported = std::min<std::size_t>(missing.size(), 8);
    const std::string more = missing.size() > reported ? " and " + std::to_string(missing.size() - reported) + " more" : "";
    throw SceneError((missing.size() == 1 ? "vertex " : "vertices ") + joined(std::span(missing).first(reported)) + more +
                     (missing.size() == 1 ? " is" : " are") + " out of range; allowed: 0 ... " + std::to_string(count - 1));
}

std::vector<int> selected(const VertexBox& box, const TriangleMesh& mesh) {
    const Bounds bounds(mesh.vertices);
    const Vec3 extent = bounds.extent();
    const double flat = box_rounding * extent.maxCoeff();
    const auto inside = [&](const Vec3& x) {
        for (int axis = 0; axis < 3; ++axis) {
            if (extent[axis] <= flat) continue;
            const double fraction = (x[axis] - bounds.lowest[axis]) / extent[axis];
            if (fraction < box.lowest[axis] - box_rounding || fraction > box.highest[axis] + box_rounding) return false;
        }
        return true;
    };
    std::vector<int> vertices;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        if (inside(mesh.vertices[i])) vertices.push_back(static_cast<int>(i));
    if (vertices.empty()) throw SceneError("no vertex lies in the box; it is in fractions of the cloth's bounding box, 0 ... 1");
    return vertices;
}

std::vector<int> selected(const VertexBoundary&, const TriangleMesh& mesh) {
    std::map<std::pair<int, int>, int> triangles_at_edge;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++triangles_at_edge[std::minmax(t[k], t[(k + 1) % 3])];
    std::vector<int> vertices;
    for (const auto& [edge, count] : triangles_at_edge)
        if (count == 1) vertices.insert(vertices.end(), {edge.first, edge.second});
    if (vertices.empty()) throw SceneError("the mesh is closed and has no boundary");
    return sorted_once(std::move(vertices));
}

}  // namespace

std::vector<int> select_vertices(const VertexSelection& selection, const TriangleMesh& mesh, const std::string& cloth_name) {
    try {
        return std::visit([&](const auto& which) { return selected(which, mesh); }, selection);
    } catch (const SceneError& error) {
        throw SceneError("vertices of cloth '" + cloth_name + "'", error.what());
    }
}

}  // namespace percale::scenes
