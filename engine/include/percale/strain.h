#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"
#include "percale/rest_shape.h"

namespace percale {

/// The deformation of a triangle from its rest shape, by its deformation gradient F (3 x 2, from the plane of rest, columns along
/// warp and weft): |F_warp| - 1, |F_weft| - 1, and the decrease of the right angle between the two, rad. Warp is given by the
/// rest shape or by the rows of a grid; where neither gives it `warp` and `weft` are the largest and the smallest stretch of the
/// triangle in any direction, singular values of F less 1, and `shear` is 0.
struct TriangleStrain {
    double warp = 0.0, weft = 0.0, shear = 0.0;
};

/// The strains of every triangle of a cloth's mesh with vertices at `positions`, m. `mesh` and `rest`: as given to
/// Simulation::add_cloth, m, the pose's scale applied. Throws SceneError for another number of positions than vertices.
/// Thread-safe.
std::vector<TriangleStrain> triangle_strains(const TriangleMesh& mesh, const RestShape& rest, std::span<const Vec3> positions);

/// Area of every vertex of an undeformed mesh, m^2, distributed like masses: a quarter of each cell of a grid that it touches, a
/// third of each triangle of another mesh. Thread-safe.
std::vector<double> vertex_areas(const TriangleMesh& mesh);

}  // namespace percale
