#pragma once

#include <array>
#include <span>
#include <string>
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

/// Whether a triangle's height over its longest edge is more than rounding.
bool has_area(const Vec3& a, const Vec3& b, const Vec3& c);

/// Throws SceneError naming `name` and, at its end, `reason` unless the mesh encloses a volume: every edge belongs to two
/// triangles, which run along it in opposite directions, and triangles are counter-clockwise seen from outside. The mesh must
/// pass check_mesh.
void check_encloses(const TriangleMesh& mesh, const std::string& name, const std::string& reason);

}  // namespace percale
