#include "geometry/cloth_surface.h"

#include <algorithm>

namespace percale {
namespace {

using Ends = std::array<int, 2>;

Ends ends_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

void collect_edges(ClothSurface& surface) {
    std::vector<Ends> all;
    for (const Triangle& t : surface.triangles) {
        for (int k = 0; k < 3; ++k) all.push_back(ends_of(t[k], t[(k + 1) % 3]));
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const Ends& ends : all) surface.edges.push_back({.vertex = ends});
}

void join_triangles(ClothSurface& surface) {
    for (int index = 0; index < static_cast<int>(surface.triangles.size()); ++index) {
        const Triangle& t = surface.triangles[index];
        std::array<int, 3>& own = surface.triangle_edges.emplace_back();
        for (int k = 0; k < 3; ++k) {
            own[k] = surface.edge_between(t[k], t[(k + 1) % 3]);
            ClothSurface::Edge& edge = surface.edges[own[k]];
            const int side = edge.triangle[0] < 0 ? 0 : 1;
            edge.triangle[side] = index;
            edge.opposite[side] = t[(k + 2) % 3];
            if (surface.vertex_owner[t[k]] < 0) surface.vertex_owner[t[k]] = index;
        }
    }
}

void collect_rings(ClothSurface& surface) {
    const std::size_t vertices = surface.vertex_owner.size();
    surface.ring_start.assign(vertices + 1, 0);
    for (const ClothSurface::Edge& edge : surface.edges) {
        for (const int vertex : edge.vertex) ++surface.ring_start[vertex + 1];
    }
    for (std::size_t v = 0; v < vertices; ++v) surface.ring_start[v + 1] += surface.ring_start[v];
    surface.ring.resize(2 * surface.edges.size());
    surface.ring_edges.resize(surface.ring.size());
    std::vector<int> next(surface.ring_start.begin(), surface.ring_start.end() - 1);
    for (int number = 0; number < static_cast<int>(surface.edges.size()); ++number) {
        const Ends& ends = surface.edges[number].vertex;
        for (int k = 0; k < 2; ++k) {
            const int place = next[ends[k]]++;
            surface.ring[place] = ends[1 - k];
            surface.ring_edges[place] = number;
        }
    }
}

}  // namespace

int ClothSurface::edge_between(int a, int b) const {
    const auto found = std::lower_bound(edges.begin(), edges.end(), ends_of(a, b),
                                        [](const Edge& edge, const Ends& ends) { return edge.vertex < ends; });
    return static_cast<int>(found - edges.begin());
}

ClothSurface make_cloth_surface(std::span<const Triangle> triangles, std::size_t vertices) {
    ClothSurface surface;
    surface.triangles.assign(triangles.begin(), triangles.end());
    surface.vertex_owner.assign(vertices, -1);
    collect_edges(surface);
    join_triangles(surface);
    collect_rings(surface);
    return surface;
}

}  // namespace percale
