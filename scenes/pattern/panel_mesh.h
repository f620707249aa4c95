#pragma once

#include <span>
#include <vector>

#include "pattern/pattern.h"

namespace percale::scenes {

/// A flat mesh. Triangles are counter-clockwise.
struct PanelMesh {
    std::vector<Point2> vertices;  // m, the outline's points first, in their order
    std::vector<Triangle> triangles;
};

/// Meshes the inside of a simple polygon, counter-clockwise, whose points are about `edge_length` apart, m. Each of its sides is
/// an edge of the mesh, and no point is added to it. Inside, points of an equilateral lattice are joined by the constrained
/// Delaunay triangulation and smoothed. Throws SceneError where the polygon crosses itself or has no area. The same polygon gives
/// the same mesh.
PanelMesh mesh_panel(std::span<const Point2> outline, double edge_length);

/// The smallest angle of all triangles, rad; 0 without any.
double smallest_angle(const PanelMesh& mesh);

}  // namespace percale::scenes
