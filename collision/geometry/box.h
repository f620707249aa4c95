#pragma once

#include "percale/mesh.h"

namespace percale {

/// Axis-parallel box, m.
struct Box {
    Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);

    void add(const Vec3& x) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    void add(const Box& other) {
        low = low.cwiseMin(other.low);
        high = high.cwiseMax(other.high);
    }
    void grow(double by) {
        low.array() -= by;
        high.array() += by;
    }
    bool overlaps(const Box& b) const { return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all(); }
    /// How far apart they are, m; 0 where they overlap.
    double gap(const Box& b) const { return (low - b.high).cwiseMax(b.low - high).cwiseMax(0.0).norm(); }
    bool contains(const Vec3& x) const { return (low.array() <= x.array()).all() && (x.array() <= high.array()).all(); }
};

}  // namespace percale
