#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Positions in which vertices of these triangles that lie within rounding of each other have one place, that of the first. A
/// smaller gap than coordinates resolve would have a meaningless direction, along which contact would push with forces that
/// exceed all others. Joined vertices touch, and are untangled as such.
std::vector<Vec3> joined_places(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace percale
