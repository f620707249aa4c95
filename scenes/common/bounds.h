#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "percale/mesh.h"

namespace percale::scenes {

/// The smallest box along the axes that holds some points; of none lowest is above highest.
struct Bounds {
    Vec3 lowest = Vec3::Constant(std::numeric_limits<double>::infinity()), highest = -lowest;

    explicit Bounds(std::span<const Vec3> points) {
        for (const Vec3& x : points) lowest = lowest.cwiseMin(x), highest = highest.cwiseMax(x);
    }
    Vec3 extent() const { return highest - lowest; }
    void grow(double by) {
        lowest.array() -= by;
        highest.array() += by;
    }
    /// The gap to another box along the axis where it is widest; below 0 where they overlap.
    double gap(const Bounds& other) const {
        return std::max((lowest - other.highest).maxCoeff(), (other.lowest - highest).maxCoeff());
    }
};

}  // namespace percale::scenes
