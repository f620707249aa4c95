#pragma once

#include <optional>
#include <span>

#include "percale/mesh.h"

namespace percale {

/// How far the convex hulls of two sets of points overlap.
struct HullOverlap {
    double depth = 0.0;             // m
    Vec3 direction = Vec3::Zero();  // unit; the first set moved by `depth` along it no longer overlaps the second
};

/// The shortest such move, by libccd's expanding polytope (GJK, van den Bergh 2001); 0.1 mm near the shortest at the size of
/// metres, never too short. Nothing where the hulls do not overlap. Both sets not empty.
std::optional<HullOverlap> hull_overlap(std::span<const Vec3> first, std::span<const Vec3> second);

}  // namespace percale
