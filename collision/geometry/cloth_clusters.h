#pragma once

#include <array>
#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// A few neighbouring cloth triangles with the vertices and edges they own (each belongs to exactly one cluster).
struct ClothCluster {
    std::vector<int> triangles;             // indices
    std::vector<int> vertices;              // owned
    std::vector<std::array<int, 2>> edges;  // owned
    std::vector<int> all_vertices;          // of its triangles, owned or not
};

/// Cloth features grouped by the order of the triangles' centres on a space-filling (Morton) curve of `positions`.
/// `edge_owner_bits[t]` has bit k set if triangle t owns its edge k (corners k, k + 1): the owner is the triangle of the lowest
/// index that has the edge, however the cloth is turned. The two vertices of an edge are in that triangle's order. `across[t][k]`
/// is the corner opposite that edge in the other triangle that has it; -1: there is none.
struct ClothClusters {
    std::vector<ClothCluster> clusters;
    std::vector<unsigned char> edge_owner_bits;
    std::vector<std::array<int, 3>> across;
};

ClothClusters make_clusters(std::span<const Triangle> triangles, std::span<const Vec3> positions);

/// The same for a known order of the triangles: that of the clusters' triangles, one cluster after the other.
ClothClusters make_clusters(std::span<const Triangle> triangles, std::size_t vertices, std::span<const int> order);

}  // namespace percale
