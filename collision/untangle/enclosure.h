#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "percale/mesh.h"
#include "untangle/untangle_obstacle.h"

namespace percale {

/// The part of an obstacle that a piece of cloth surrounds: places inside the obstacle about which the solid angle of the cloth
/// is more than half of all directions, each of its rims closed by a fan about the rim's middle. Only a tube, a piece with two
/// rims or more, surrounds something, and only what passes through two of them while part of the cloth is outside: a skirt
/// surrounds a waist, but not the floor that it dips into. An open obstacle has no inside and is never surrounded.
class Enclosure {
public:
    /// `triangles`: of a connected piece, wound alike.
    Enclosure(std::vector<Triangle> triangles, std::span<const Vec3> positions, const SolidObstacle& obstacle);

    /// Whether cloth at `positions` surrounds fewer than half of the places that it surrounded first.
    bool lost(std::span<const Vec3> positions) const;

private:
    struct RimEdge {
        int from, to;  // against the winding
        int rim;
    };

    void find_rims(std::size_t vertex_count);
    bool passes_through(std::span<const Vec3> positions, const SolidObstacle& obstacle) const;
    bool surrounds(const Vec3& place, std::span<const Vec3> positions, std::span<const Vec3> middles) const;
    std::vector<Vec3> middles(std::span<const Vec3> positions) const;

    std::vector<Triangle> triangles_;
    std::vector<RimEdge> rims_;
    int rim_count_ = 0;
    std::vector<Vec3> surrounded_;  // m
};

}  // namespace percale
