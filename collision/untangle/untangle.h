#pragma once

#include <optional>
#include <span>

#include "percale/contact.h"
#include "untangle/untangle_check.h"

namespace percale {

/// Implements ContactDetector::untangle for cloth and obstacles at fixed places. Each connected patch of vertices in conflict
/// (untangle_check.h) leaves as a whole, and the cloth around it follows: by the shortest of several straight routes, or
/// everywhere by the nearest place of the surface where that tears nothing. Routes that stretch no edge by more than half are
/// preferred.
std::optional<Untangled> untangle(const TangledCloth& cloth, std::span<const SolidObstacle> obstacles,
                                  std::span<const Vec3> positions);

}  // namespace percale
