#pragma once

#include <span>

#include "percale/mesh.h"
#include "vertex_order.h"

namespace percale {

/// One cloth among others.
struct NormalMesh {
    std::span<const Triangle> triangles;  // its own, in the numbers of the points
    std::span<const Vec3> points;         // m, of all cloth
    int first_vertex = 0;                 // of its vertices, which follow each other
    const VertexOrder& order;
};

/// Unit normals of its vertices, in the user's order: sum of (b - a) x (c - a) over the triangles around each. Zero where that
/// is at most min_normal_ratio of the sum of |b - a| |c - a|.
void vertex_normals(const NormalMesh& mesh, std::span<Vec3> normals);

}  // namespace percale
