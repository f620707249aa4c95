#include "line_search.h"

#include <algorithm>
#include <cmath>

namespace percale {

bool accept_trial(double fraction, const LineTrial& trial) {
    if (!std::isfinite(trial.objective) || !std::isfinite(trial.slope)) return false;
    if (trial.slope > trial.most_turned * std::abs(trial.start_slope)) return false;
    const bool gentle = trial.slope <= 0.9 * std::abs(trial.start_slope);
    if (trial.objective <= trial.start_objective + 1e-4 * fraction * trial.start_slope) return true;
    if (!trial.objective_known) return gentle;
    const bool flat = trial.objective <= trial.start_objective + 1e-9 * std::abs(trial.start_objective);
    return flat && gentle;
}

double shorten(const LineTrial& trial) {
    const double rise = trial.slope - trial.start_slope;
    if (!(rise > 0.0) || !std::isfinite(rise)) return 0.5;
    return std::clamp(-trial.start_slope / rise, 0.15, 0.6);
}

}  // namespace percale
