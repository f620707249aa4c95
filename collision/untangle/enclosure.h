#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// What a piece of cloth surrounds: the points about which its solid angle is more than half of all directions, each of its rims
/// closed by a fan about the rim's middle. A skirt surrounds a waist; a sheet or a ball,
/// pieces with fewer than two rims, surround nothing.
class Enclosure {
public:
    /// `triangles`: of a connected piece, wound alike. `points`: m, those that may be surrounded.
    Enclosure(std::vector<Triangle> triangles, std::span<const Vec3> positions, std::span<const Vec3> points);

    /// Where cloth at `positions` surrounds fewer than half of the points that it surrounded first.
    bool lost(std::span<const Vec3> positions) const;

private:
    bool surrounds(const Vec3& point, std::span<const Vec3> positions, std::span<const Vec3> middles) const;
    std::vector<Vec3> middles(std::span<const Vec3> positions) const;

    std::vector<Triangle> triangles_;
    std::vector<std::array<int, 3>> rims_;  // edges of rims, against the winding, and the number of the rim
    int rim_count_ = 0;
    std::vector<Vec3> surrounded_;  // m
};

}  // namespace percale
