#pragma once

#include <limits>

#include "newton_stop.h"
#include "stage_equations.h"

namespace percale {

/// Where a line search stands: objective and slope (residual . direction) at its start and at a trial.
struct LineTrial {
    double start_objective = 0.0;  // J
    double start_slope = 0.0;      // J, < 0 for a descent direction
    double objective = 0.0;
    double slope = 0.0;
    bool objective_known = true;  // false with contact: friction has no potential, rows come and go
    /// Largest slope beyond the minimum, over the first one's size, whatever the objective says.
    double most_turned = std::numeric_limits<double>::infinity();
};

/// Whether a trial is good enough: Armijo's rule on the objective, or, where that is flat to rounding or not known, a slope that
/// has not turned up to 0.9 of the first one's size; never one beyond most_turned.
bool accept_trial(double fraction, const LineTrial& trial);

/// The factor for the next trial: the zero of the slope by the secant, kept within 0.15 ... 0.6.
double shorten(const LineTrial& trial);

/// What a search along a direction came to; space.current is where it ended.
struct LineResult {
    bool small = false;     // the whole direction changes less than a share of the time error
    bool whole = false;     // all of it was taken, by pins and obstacles that had arrived
    bool stuck = false;     // nothing can be gained along it but rounding
    bool went_on = false;   // beyond it, by the secant: the matrix is not that of this state
    int cuts = 0;           // trials that were shortened
    bool met_rows = false;  // nothing was done: the whole of it ends in rows that were in no matrix, now in space.foreseen
};

/// Goes from space.current along space.direction: the whole of it, cut where something would cross and shortened until
/// accept_trial agrees; further by the secant where the slope has hardly fallen. With `stop_at_rows` it may do nothing
/// (LineResult::met_rows), for another direction to be found.
LineResult search_line(StageEquations& equations, const TimeError& error, bool stop_at_rows = false);

}  // namespace percale
