#pragma once

#include <limits>

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

}  // namespace percale
