#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Of a closed surface the triangles that have the solid on both sides (winding number not 0, Jacobson et al. 2013): parts of a
/// mesh that overlap leave them inside. Nothing can meet them without crossing others first. A triangle that others cross is
/// never counted among them; none is where more than 200 pairs a triangle and two million would have to be tested.
std::vector<bool> internal_faces(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
