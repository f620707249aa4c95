#pragma once

#include <array>
#include <string>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// The strain-free shape of a cloth, where that is not its mesh at the start, and the direction of its warp. For free meshes; a
/// grid is its own rest shape, warp along its rows.
struct RestShape {
    /// m, the corners of every triangle of the mesh, in its order and in the order of its vertices; empty: those of the mesh. A
    /// vertex may have a different place in each of its triangles, as in panels laid out flat: an edge then has the mean of its
    /// lengths, and the surface is flat across it.
    std::vector<std::array<Vec3, 3>> corners;
    /// Direction of warp, of any length, in the space of the corners; each triangle takes the projection onto its plane. Zero:
    /// not given, which only isotropic fabrics allow.
    Vec3 warp = Vec3::Zero();

    bool said() const { return !corners.empty() || warp != Vec3::Zero(); }
};

/// The rest shape given by another mesh of the same triangles, its vertices in m. Throws SceneError naming `name` where the
/// triangles are not the same, number for number.
RestShape rest_shape_of(const TriangleMesh& mesh, const TriangleMesh& rest, const std::string& name);

/// Throws SceneError naming `name` and the triangle: a grid, another number of triangles than the mesh has, a corner that is not
/// finite, a triangle without area or one that warp is normal to.
void check_rest_shape(const TriangleMesh& mesh, const RestShape& shape, const std::string& name);

}  // namespace percale
