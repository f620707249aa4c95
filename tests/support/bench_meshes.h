#pragma once

#include "percale/mesh.h"

namespace percale::test {

/// Free meshes of irregular triangles and a requested number of vertices (300 ... 300000, met within 10 %), the same for the
/// same arguments. Rows of points at random distances, triangulated along the shorter diagonal; the order of vertices is
/// undefined unless stated here. All pass check_mesh for cloth. Lengths in m.

/// Square sheet in the plane y = 0, centred, normals +y. Vertex 0 is the corner (-size/2, 0, -size/2).
TriangleMesh irregular_sheet(double size, int vertices);

/// Open frustum of a cone about the y axis: waist (radius 0.15) at y = 0, hem (radius 0.4) at y = -0.6, normals outwards.
TriangleMesh tube_skirt(int vertices);

/// T-shirt, front and back 2 mm to 3 cm apart (a fraction of the vertices' spacing) and joined at shoulders, sides and under the
/// arms; open at neck, hem and sleeves. 1.1 m from sleeve to sleeve, 0.7 m high, upright, centred about the y axis, the hem at y
/// = 0.
TriangleMesh t_shirt(int vertices);

/// The same mesh with its vertices numbered at random, the same numbers for the same mesh: vertices near in space are then far
/// apart in memory. A grid becomes a free mesh.
TriangleMesh shuffled(const TriangleMesh& mesh);

/// The vertex nearest to a point.
int nearest_vertex(const TriangleMesh& mesh, const Vec3& point);

/// Longest edge over smallest height, of the worst triangle; 2/sqrt(3) for equilateral ones.
double worst_aspect(const TriangleMesh& mesh);

}  // namespace percale::test
