#pragma once

#include <array>
#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// An edge of a triangle mesh, vertex[0] < vertex[1], and the vertices opposite to it in its (at most two) triangles; -1 = none.
struct MeshEdge {
    std::array<int, 2> vertex;
    std::array<int, 2> opposite;
};

/// Every edge once, ordered by its vertices. The mesh must be edge-manifold (check_mesh).
std::vector<MeshEdge> mesh_edges(std::span<const Triangle> triangles);

}  // namespace percale
