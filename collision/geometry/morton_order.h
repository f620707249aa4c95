#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Numbers of the triangles along a space-filling (Morton) curve through their centres: neighbours in the order are near each
/// other. Equal places keep their order.
std::vector<int> morton_order(std::span<const Triangle> triangles, std::span<const Vec3> positions);

}  // namespace percale
