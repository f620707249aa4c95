#pragma once

#include <optional>
#include <span>
#include <vector>

#include "percale/contact.h"

namespace percale {

/// Cloth that meets cloth, as it starts.
struct CrossedCloth {
    std::span<const Triangle> triangles;
    std::span<const double> free;      // 0: stays
    std::span<const Stitch> stitches;  // vertices that they join get one place
};

/// Positions of cloth that crosses no cloth, near the given ones; nothing where it did not come apart. All edges that pierce a
/// triangle are moved back, round by round, so that the curves in which cloth crosses cloth get shorter until they vanish: what
/// is on the smaller side of each goes back. Between rounds edges are drawn to the lengths that they had.
std::optional<std::vector<Vec3>> untangle_cloth(const CrossedCloth& cloth, std::span<const Vec3> positions);

}  // namespace percale
