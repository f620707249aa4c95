#pragma once

#include <array>
#include <string>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Cloth without strain, where that is not its mesh as it starts, and where its warp runs. For free meshes; a grid is its own
/// rest shape, warp along its rows.
struct RestShape {
    /// m, the corners of every triangle of the mesh, in its order and in the order of its vertices; empty: as the mesh lies. A
    /// vertex may have a place of its own in each of its triangles, as panels laid out flat have: an edge is then as long as the
    /// mean of its lengths, and what is joined along it is flat there.
    std::vector<std::array<Vec3, 3>> corners;
    /// Direction of warp, of any length, where the corners are; in a triangle it runs along what of it lies in its plane. Zero:
    /// not said, which only isotropic fabrics allow.
    Vec3 warp = Vec3::Zero();

    bool said() const { return !corners.empty() || warp != Vec3::Zero(); }
};

/// The rest shape that another mesh of the same triangles has, its vertices in m. Throws SceneError naming `name` where the
/// triangles are not the same, number for number.
RestShape rest_shape_of(const TriangleMesh& mesh, const TriangleMesh& rest, const std::string& name);

/// Throws SceneError naming `name` and the triangle: a grid, another number of triangles than the mesh has, a corner that is not
/// finite, a triangle without area or one that warp is normal to.
void check_rest_shape(const TriangleMesh& mesh, const RestShape& shape, const std::string& name);

}  // namespace percale
