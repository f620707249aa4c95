#pragma once

#include <optional>
#include <span>

#include "percale/contact.h"
#include "untangle/untangle_check.h"

namespace percale {

/// ContactDetector::untangle for cloth and obstacles at one place. Each connected patch of vertices in conflict
/// (untangle_check.h) leaves as a whole, the cloth around it following: by the shortest of several straight ways, or everywhere
/// by the nearest place of the surface where that tears nothing. Ways that stretch no edge by more than half come first.
std::optional<Untangled> untangle(const TangledCloth& cloth, std::span<const SolidObstacle> obstacles,
                                  std::span<const Vec3> positions);

}  // namespace percale
