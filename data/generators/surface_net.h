#pragma once

#include <functional>

#include "percale/mesh.h"

namespace percale::scenes {

/// Negative inside, positive outside, continuous, the same at x and -x.
using DistanceField = std::function<double(const Vec3&)>;

/// m; every point inside lies in it and its mirror image (its own x starts at 0).
struct Box {
    Vec3 lowest, highest;
};

/// Surface nets on a cubic lattice: a vertex in every cell that the zero surface cuts, at the mean of the cuts, and two triangles
/// around every lattice edge that it cuts, normals outward. Only the half x >= 0, open along its seam, whose vertices have x == 0
/// exactly. Manifold: gaps and bridges narrower than the spacing (> 0, m) that would pinch the surface are filled.
TriangleMesh half_surface_net(const DistanceField& field, const Box& box, double spacing);

/// A half and its mirror image at x = 0, sharing the vertices with x == 0.
TriangleMesh mirrored(const TriangleMesh& half);

}  // namespace percale::scenes
