#pragma once

#include <limits>
#include <optional>

#include "linear/energy_error_estimate.h"
#include "stage_equations.h"

namespace percale {

/// The data of the time error, with which the solver's own error is compared.
struct TimeError {
    const Compute* compute = nullptr;
    const ClothModel* model = nullptr;
    const AlignedVector<double>* free = nullptr;
    double dt = 0.0;                           // s, h of the stage
    const Vec3Arrays* start = nullptr;         // m/s, v_n
    const Vec3Arrays* extrapolated = nullptr;  // StageBase::extrapolated; null for backward Euler
    double extrapolated_error_ratio = 1.0;
    double allowance = std::numeric_limits<double>::infinity();  // m, allowance of adaptive steps for the stage
};

/// Largest change relative to the time error: StepSettings::newton_error_ratio, in adaptive steps at most a quarter, as their
/// lengths are chosen by the time error alone.
double allowed_error_ratio(const StepSettings& settings);

/// The time error of a stage.
TimeError time_error_of(const ImplicitStage& stage);

/// |v - v_n|_M^2 over the free ones of some vertices, J: the time error of backward Euler is dt/2 times its root over the mass.
/// With another scheme it is `extrapolated_error_ratio` |v - extrapolated|, where that is less.
double squared_error(const TimeError& error, int first, int count, const Vec3Arrays& velocities);

/// A Newton direction that leads to the velocities `ahead`.
struct NewtonChange {
    const Vec3Arrays& residual;   // kg m/s
    const Vec3Arrays& direction;  // m/s
    const Vec3Arrays& ahead;      // m/s
    bool in_contact = false;
};

/// Whether the direction changes every cloth of a body, of the mass m, by little in the mean and at its worst vertex:
///     dt sqrt(-r . dv/m) <= error_ratio dt/2 |v - v_n|_M/sqrt(m) + floor,
///     dt max|dv| <= error_ratio dt/2 max|v - v_n| + 10 floor in contact, without 4 times the first term,
/// |v - v_n| replaced by extrapolated_error_ratio |v - extrapolated| where that is less. The floor, m, is 2e-5 of the thickness
/// (in contact 2e-4), or a tenth of the allowance if that is less.
bool change_is_small(const TimeError& error, const NewtonChange& change, double error_ratio, const Body& body);

/// The accelerations of each body by its contact forces, m/s^2, RMS by mass: sqrt(sum (w N)^2/m_i / m).
void contact_accelerations(const ClothModel& model, const StagePoint& point, std::vector<double>& accelerations);
/// Whether such an acceleration before and after a line has settled: it changed by less than a factor of 1.5, or by a twentieth
/// of gravity.
bool contact_is_settled(double before, double now, double gravity);

/// The time error itself, m: the mass-weighted RMS of the cloth where it is largest.
double time_error(const TimeError& error, const Vec3Arrays& velocities);

/// The progress of a Newton iteration.
struct NewtonProgress {
    int iteration = 0;
    double ratio = 1.0;     // of its residual to the one before
    double residual = 1.0;  // relative to the first
};

/// The accuracy of a linear solve. With a residual to reach, the linear residual follows the Newton residual (Eisenstat and
/// Walker 1996, choice 2); else the energy gained per iteration decides, which bounds the smooth error that a loose residual
/// leaves behind.
SolveTarget solve_target(const TimeError& error, const NewtonProgress& progress, const StepSettings& settings,
                         const Vec3Arrays& velocities);

}  // namespace percale
