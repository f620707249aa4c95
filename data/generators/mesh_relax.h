#pragma once

#include <functional>
#include <vector>

#include "percale/mesh.h"

// Turns a rough triangulation into one with well-shaped triangles; used by the generators of our own meshes.
namespace percale::scenes {

/// Flips inner edges where that raises the smallest angle of the two triangles beside them and does not fold the surface, in
/// sweeps until nothing improves. Vertices stay. Returns the number of flips.
int flip_edges(TriangleMesh& mesh);

/// Merges the ends of edges shorter than `length` (m) where the surface keeps its topology and no triangle turns over or becomes
/// worse than 5 degrees; vertices of the boundary stay. Vertices are renumbered, their order kept. Returns the number of merges.
int collapse_short_edges(TriangleMesh& mesh, double length);

/// Where a vertex (by index) that was moved to a place belongs, e.g. the nearest point of the surface it lies on.
using Projection = std::function<Vec3(std::size_t vertex, const Vec3& moved)>;

/// Moves every vertex half way to the mean of its neighbours, then where `project` puts it.
void smooth(TriangleMesh& mesh, const Projection& project);

/// Rounds of smooth and flip_edges.
void relax(TriangleMesh& mesh, int rounds, const Projection& project);

/// Vertices on an edge that belongs to one triangle only.
std::vector<bool> boundary_vertices(const TriangleMesh& mesh);

/// Smallest angle of any triangle, in degrees.
double smallest_angle(const TriangleMesh& mesh);

}  // namespace percale::scenes
