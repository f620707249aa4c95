#pragma once

#include "model/cloth_model.h"

namespace percale {

/// What an implicit stage M (v - v*) = h f(q* + h v, v), q = q* + h v, goes out from. Backward Euler: q_n, v_n, h = dt.
struct StageBase {
    double h = 0.0;            // s
    Vectors positions;         // m, q*
    Vectors velocities;        // m/s, v*
    Vectors foreseen;          // m/s, v_n + (length of the stage) a_n, which v would be if accelerations stayed
    double error_share = 1.0;  // the stage's time error over h/2 |v - foreseen|
};

// In all of them `acceleration`, m/s^2, is that of the start.

/// Implicit midpoint: a stage of backward Euler to the middle, from which the end is extrapolated.
void set_midpoint_base(const ClothState& start, const Vectors& acceleration, double dt, StageBase& base);

/// Trapezoid over `length`: q* = q_n + h v_n, v* = v_n + h a_n, h = length/2.
void set_trapezoid_base(const ClothState& start, const Vectors& acceleration, double length, StageBase& base);

/// BDF2 over `length`, after a step of `length_before` from an earlier state: with r = length/length_before
///     y* = y_n + r^2/(1 + 2r) (y_n - y_(n-1)),   h = length (1 + r)/(1 + 2r).
void set_bdf2_base(const ClothState& start, const Vectors& acceleration, const ClothState& earlier, double length,
                   double length_before, StageBase& base);

/// Prescribed vertices (free = 0) go from `start` to `targets` at a steady speed.
void set_prescribed_base(const AlignedVector<double>& free, const Vectors& start, const Vectors& targets, double length,
                         StageBase& base);

/// to = a + factor (b - c)
void set_extrapolated(const Vectors& a, double factor, const Vectors& b, const Vectors& c, Vectors& to);

}  // namespace percale
