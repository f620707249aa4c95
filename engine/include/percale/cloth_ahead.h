#pragma once

#include <limits>

#include "percale/mesh.h"

namespace percale {

/// The predicted motion of a cloth during a step at constant velocity, against which an obstacle's motion is measured.
class ClothAhead {
public:
    /// `thickness`: m; `dt`: length of the step, s.
    ClothAhead(double thickness, double dt) : thickness_(thickness), dt_(dt) {}

    /// A vertex, m and m/s.
    void add(const Vec3& position, const Vec3& velocity) {
        const Vec3 displacement = dt_ * velocity;
        for (const Vec3& x : {position, Vec3(position + displacement)}) {
            low_ = low_.cwiseMin((x.array() - thickness_).matrix());
            high_ = high_.cwiseMax((x.array() + thickness_).matrix());
        }
        displacements_ += displacement;
        ++count_;
    }

    double thickness() const { return thickness_; }

    /// Whether the box of a ball of that radius, m, moving from one place to the other, meets the cloth's.
    bool meets(const Vec3& from, const Vec3& to, double radius) const {
        const Vec3 low = (from.cwiseMin(to).array() - radius).matrix(), high = (from.cwiseMax(to).array() + radius).matrix();
        return (low_.array() <= high.array()).all() && (low.array() <= high_.array()).all();
    }

    /// A displacement relative to the mean one of the cloth's vertices, m.
    Vec3 beside(const Vec3& displacement) const { return displacement - displacements_ / static_cast<double>(count_); }

private:
    double thickness_, dt_;
    Vec3 low_ = Vec3::Constant(std::numeric_limits<double>::max()), high_ = -low_, displacements_ = Vec3::Zero();
    int count_ = 0;
};

}  // namespace percale
