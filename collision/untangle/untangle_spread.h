#pragma once

#include <span>
#include <vector>

#include "untangle/untangle_check.h"

namespace percale {

/// For each vertex its distance along edges from the nearest vertex that stays, m; infinity where none does.
std::vector<double> distance_from_fixed(const TangledCloth& cloth, std::span<const Vec3> positions);

/// Makes the cloth around follow: `moves` (m) of vertices in the core stay as they are, other vertices follow the core vertex
/// whose move is largest there after half the length to it along edges is subtracted. No vertex moves farther than its `limit`,
/// m.
void spread_moves(const TangledCloth& cloth, std::span<const Vec3> positions, const std::vector<bool>& core,
                  std::span<const double> limit, std::vector<Vec3>& moves);

/// Largest (l - l0)/l0 of a triangle's edge from one state to another.
double largest_stretch(const TangledCloth& cloth, std::span<const Vec3> from, std::span<const Vec3> to);

}  // namespace percale
