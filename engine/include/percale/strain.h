#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"
#include "percale/rest_shape.h"

namespace percale {

/// How a triangle is deformed against its rest shape, by its deformation gradient F (3 x 2, from the plane of rest, columns along
/// warp and weft): |F_warp| - 1, |F_weft| - 1, and by how much the angle between the two is less than a right one, rad. Warp is
/// where the rest shape or the rows of a grid say; where neither does `warp` and `weft` are the largest and the smallest stretch
/// of the triangle in any direction, singular values of F less 1, and `shear` is 0.
struct TriangleStrain {
    double warp = 0.0, weft = 0.0, shear = 0.0;
};

/// Of every triangle of a cloth's mesh whose vertices are at `positions`, m. `mesh` and `rest`: as given to
/// Simulation::add_cloth, m, the pose's scale applied. Throws SceneError for another number of positions than vertices.
/// Thread-safe.
std::vector<TriangleStrain> triangle_strains(const TriangleMesh& mesh, const RestShape& rest, std::span<const Vec3> positions);

/// Area of every vertex of a mesh as it lies, m^2, shared out as masses are: a quarter of each cell of a grid that it touches, a
/// third of each triangle of another mesh. Thread-safe.
std::vector<double> vertex_areas(const TriangleMesh& mesh);

}  // namespace percale
