#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Positions in which vertices of these triangles that lie within rounding of each other lie in one place, that of the first:
/// apart by less than coordinates have digits they would be apart in a direction that nothing means, and contact would push with
/// forces that drown all others. What is joined touches, and is taken apart as such.
std::vector<Vec3> joined_places(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace percale
