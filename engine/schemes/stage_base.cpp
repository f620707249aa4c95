#include "stage_base.h"

namespace percale {
namespace {

void set_sum(const Vectors& a, double factor, const Vectors& b, Vectors& to) {
    to = a;
    add_scaled(to, factor, b);
}

}  // namespace

void set_extrapolated(const Vectors& a, double factor, const Vectors& b, const Vectors& c, Vectors& to) {
    to = a;
    add_scaled(to, factor, b);
    add_scaled(to, -factor, c);
}

// Local errors of position where accelerations change at the rate j: dt^3 j/12 of midpoint and trapezoid, 2/9 dt^3 j of BDF2 with
// r = 1. v - foreseen is dt^2 j/4 of the midpoint's stage, whose errors the extrapolation doubles, and dt^2 j/2 of the others.

void set_midpoint_base(const ClothState& start, const Vectors& acceleration, double dt, StageBase& base) {
    base.h = 0.5 * dt;
    base.positions = start.positions;
    base.velocities = start.velocities;
    set_sum(start.velocities, base.h, acceleration, base.foreseen);
    base.error_share = 2.0 / 3.0;
}

void set_trapezoid_base(const ClothState& start, const Vectors& acceleration, double length, StageBase& base) {
    base.h = 0.5 * length;
    set_sum(start.positions, base.h, start.velocities, base.positions);
    set_sum(start.velocities, base.h, acceleration, base.velocities);
    set_sum(start.velocities, length, acceleration, base.foreseen);
    base.error_share = 2.0 / 3.0;
}

void set_bdf2_base(const ClothState& start, const Vectors& acceleration, const ClothState& earlier, double length,
                   double length_before, StageBase& base) {
    const double ratio = length / length_before, further = ratio * ratio / (1.0 + 2.0 * ratio);
    base.h = length * (1.0 + ratio) / (1.0 + 2.0 * ratio);
    set_extrapolated(start.positions, further, start.positions, earlier.positions, base.positions);
    set_extrapolated(start.velocities, further, start.velocities, earlier.velocities, base.velocities);
    set_sum(start.velocities, length, acceleration, base.foreseen);
    base.error_share = 4.0 / 3.0;
}

void set_prescribed_base(const AlignedVector<double>& free, const Vectors& start, const Vectors& targets, double length,
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
