#include "stage_base.h"

namespace percale {
namespace {

void set_sum(const Vec3Arrays& a, double factor, const Vec3Arrays& b, Vec3Arrays& to) {
    to = a;
    add_scaled(to, factor, b);
}

}  // namespace

void set_extrapolated(const Vec3Arrays& a, double factor, const Vec3Arrays& b, const Vec3Arrays& c, Vec3Arrays& to) {
    to = a;
    add_scaled(to, factor, b);
    add_scaled(to, -factor, c);
}

void set_euler_base(const ClothState& start, double length, StageBase& base) {
    base.h = length;
    base.positions = start.positions;
    base.velocities = start.velocities;
    base.extrapolated.resize(0);
    base.error_ratio = 1.0;
}

// Local errors of position where accelerations change at the rate j: dt^3 j/12 of midpoint and trapezoid, 2/9 dt^3 j of BDF2
// with r = 1. v - extrapolated is dt^2 j/4 of the midpoint's stage, whose errors the extrapolation doubles, and dt^2 j/2 of the
// others.

void set_midpoint_base(const ClothState& start, const Vec3Arrays& acceleration, double dt, StageBase& base) {
    base.h = 0.5 * dt;
    base.positions = start.positions;
    base.velocities = start.velocities;
    set_sum(start.velocities, base.h, acceleration, base.extrapolated);
    base.error_ratio = 2.0 / 3.0;
}

void set_trapezoid_base(const ClothState& start, const Vec3Arrays& acceleration, double length, StageBase& base) {
    base.h = 0.5 * length;
    set_sum(start.positions, base.h, start.velocities, base.positions);
    set_sum(start.velocities, base.h, acceleration, base.velocities);
    set_sum(start.velocities, length, acceleration, base.extrapolated);
    base.error_ratio = 2.0 / 3.0;
}

void set_bdf2_base(const ClothState& start, const Vec3Arrays& acceleration, const ClothState& earlier, double length,
                   double length_before, StageBase& base) {
    const double ratio = length / length_before, further = ratio * ratio / (1.0 + 2.0 * ratio);
    base.h = length * (1.0 + ratio) / (1.0 + 2.0 * ratio);
    set_extrapolated(start.positions, further, start.positions, earlier.positions, base.positions);
    set_extrapolated(start.velocities, further, start.velocities, earlier.velocities, base.velocities);
    set_sum(start.velocities, length, acceleration, base.extrapolated);
    base.error_ratio = 4.0 / 3.0;
}

void set_prescribed_base(const AlignedVector<double>& free, const Vec3Arrays& start, const Vec3Arrays& targets, double length,
                         StageBase& base) {
    for (std::size_t i = 0; i < start.padded_size(); ++i) {
        if (free[i] > 0.0) continue;
        const int vertex = static_cast<int>(i);
        const Vec3 velocity = (targets.at(vertex) - start.at(vertex)) / length;
        base.positions.set(vertex, targets.at(vertex) - base.h * velocity);
        base.velocities.set(vertex, velocity);
    }
}

}  // namespace percale
