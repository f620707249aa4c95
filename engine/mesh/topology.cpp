#include "topology.h"

#include <algorithm>

namespace percale {

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

}  // namespace percale
