#pragma once

#include <optional>
#include <span>
#include <vector>

#include "untangle/merged_cloth.h"

namespace percale {

/// Positions of cloth that crosses no cloth, near the given ones; nothing where untangling failed. All edges that pierce a
/// triangle are moved back, round by round, so that the curves in which cloth crosses cloth get shorter until they vanish: the
/// smaller side of each goes back. Between rounds edges are drawn to the lengths that they had. Vertices at a closed stitch move
/// as one (merge_sewn), the sides of open stitches do not separate further.
std::optional<std::vector<Vec3>> untangle_cloth(const CrossedCloth& cloth, std::span<const Vec3> positions);

}  // namespace percale
