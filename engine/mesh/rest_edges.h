#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "percale/rest_shape.h"
#include "topology.h"

namespace percale {

/// A cloth's mesh, in m, and its rest shape where that is another one.
struct ShapedMesh {
    const TriangleMesh& mesh;
    const RestShape& shape;
};

/// The corners of a triangle of the mesh where it has no strain, m.
std::array<Vec3, 3> rest_corners(const TriangleMesh& mesh, const RestShape& shape, std::size_t triangle);

/// The same in their plane, m: the first at the origin, x along warp. Warp is that of the shape, in the triangle's plane; else
/// the row of a grid along which the triangle has an edge, or any edge of a free mesh.
std::array<Eigen::Vector2d, 3> corners_in_plane(const ShapedMesh& rest, std::size_t triangle);

/// An edge and its triangles without strain: both ends, then the opposite vertices (zero where there is no triangle), m.
struct RestEdge {
    std::array<Vec3, 4> corner;
    double length = 0.0;  // m; the mean where the two triangles do not agree
};

/// The rest edges of mesh_edges(triangles), in its order. Where two triangles have no places in common for the ends of their
/// edge, or lie on one side of it in a plane (panels laid out mirrored), the second is unfolded into the plane of the first.
/// `corners`: of every triangle, m.
std::vector<RestEdge> rest_edges(std::span<const Triangle> triangles, std::span<const MeshEdge> edges,
                                 std::span<const std::array<Vec3, 3>> corners);

}  // namespace percale
