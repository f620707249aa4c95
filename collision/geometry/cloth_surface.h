#pragma once

#include <array>
#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Which features of cloth are neighbours. Edges belong to at most two triangles.
struct ClothSurface {
    struct Edge {
        std::array<int, 2> vertex{-1, -1};    // ascending
        std::array<int, 2> triangle{-1, -1};  // the first owns it; -1: boundary
        std::array<int, 2> opposite{-1, -1};  // the third vertex of each triangle
    };

    std::vector<Triangle> triangles;
    std::vector<std::array<int, 3>> triangle_edges;  // edge k joins corners k and k + 1
    std::vector<Edge> edges;                         // in ascending order of their vertices
    std::vector<int> vertex_owner;                   // lowest triangle at a vertex, -1: none
    std::vector<int> ring_start, ring;  // neighbours of vertex v: ring[ring_start[v]] ... ring[ring_start[v + 1] - 1]
    std::vector<int> ring_edges;        // the edges to them

    std::span<const int> neighbours(int vertex) const {
        return std::span(ring).subspan(ring_start[vertex], ring_start[vertex + 1] - ring_start[vertex]);
    }
    std::span<const int> edges_at(int vertex) const {
        return std::span(ring_edges).subspan(ring_start[vertex], ring_start[vertex + 1] - ring_start[vertex]);
    }
    /// The edge between two vertices; they must be neighbours.
    int edge_between(int a, int b) const;
};

ClothSurface make_cloth_surface(std::span<const Triangle> triangles, std::size_t vertices);

}  // namespace percale
