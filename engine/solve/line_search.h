#pragma once

#include "body_states.h"
#include "newton_stop.h"
#include "stage_equations.h"

namespace percale {

/// The state of a line search: objective and slope (residual . direction) at its start and at a trial.
struct LineTrial {
    double start_objective = 0.0;  // J
    double start_slope = 0.0;      // J, < 0 for a descent direction
    double objective = 0.0;
    double slope = 0.0;
    /// False with contact, as friction has no potential and constraints come and go, and with damping by velocity: the slope then
    /// decides alone.
    bool objective_known = true;
};

/// Whether a trial is good enough: Armijo's rule on the objective, or, where that is flat to rounding or not known, the curvature
/// condition on one side, a slope beyond the minimum of at most 0.9 of the first one's size (Nocedal and Wright, Numerical
/// Optimization, section 3.1).
bool accept_trial(double fraction, const LineTrial& trial);

/// The factor for the next trial: the zero of the slope by the secant, kept within 0.15 ... 0.6.
double shorten(const LineTrial& trial);

/// A search along a direction.
struct LineTask {
    const TimeError& error;       // with which the change by the direction is compared
    const Vec3Arrays& direction;  // m/s
    BodyStates& bodies;           // marked: whether the direction changes them by little
};

struct LineResult {
    bool small = false;      // the whole direction changes each unsettled body by newton_error_ratio of its time error at most
    bool tiny = false;       // a tenth of that, with pins and obstacles already in place
    bool full_step = false;  // the whole direction was taken, with pins and obstacles already in place
    bool stuck = false;      // the whole direction is rounding of positions: counts as converged
    int backtracks = 0;      // shortened trials
};

/// Moves `current` along a direction: a full step, clamped where something would cross and shortened until accept_trial agrees.
/// After max_line_trials trials the last one is taken. `trial` is at the end where the line began.
LineResult search_line(StageEquations& equations, const LineTask& task, StagePoint& current, StagePoint& trial);

}  // namespace percale
