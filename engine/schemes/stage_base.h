#pragma once

#include "model/cloth_state.h"
#include "support/aligned.h"

namespace percale {

/// The base of an implicit stage M (v - v*) = h f(q* + h v, v), q = q* + h v. Backward Euler: q_n, v_n, h = dt.
struct StageBase {
    double h = 0.0;           // s
    Vec3Arrays positions;     // m, q*
    Vec3Arrays velocities;    // m/s, v*
    Vec3Arrays extrapolated;  // m/s, v_n + (length of the stage) a_n, the end value of v at constant acceleration; empty: unknown
    double error_ratio = 1.0;  // the stage's time error over h/2 |v - extrapolated|
};

/// Backward Euler over `length`: q* = q_n, v* = v_n, h = length.
void set_euler_base(const ClothState& start, double length, StageBase& base);

// In all other functions `acceleration`, m/s^2, is that of the start.

/// Implicit midpoint: a stage of backward Euler to the middle, from which the end is extrapolated.
void set_midpoint_base(const ClothState& start, const Vec3Arrays& acceleration, double dt, StageBase& base);

/// Trapezoid over `length`: q* = q_n + h v_n, v* = v_n + h a_n, h = length/2.
void set_trapezoid_base(const ClothState& start, const Vec3Arrays& acceleration, double length, StageBase& base);

/// BDF2 over `length`, after a step of `length_before` from an earlier state: with r = length/length_before
///     y* = y_n + r^2/(1 + 2r) (y_n - y_(n-1)),   h = length (1 + r)/(1 + 2r).
void set_bdf2_base(const ClothState& start, const Vec3Arrays& acceleration, const ClothState& earlier, double length,
                   double length_before, StageBase& base);

/// Prescribed vertices (free = 0) move from `start` to `targets` at a steady speed.
void set_prescribed_base(const AlignedVector<double>& free, const Vec3Arrays& start, const Vec3Arrays& targets, double length,
                         StageBase& base);

/// to = a + factor (b - c)
void set_extrapolated(const Vec3Arrays& a, double factor, const Vec3Arrays& b, const Vec3Arrays& c, Vec3Arrays& to);

}  // namespace percale
