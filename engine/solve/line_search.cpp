#include "line_search.h"

#include <algorithm>
#include <cmath>

#include "tolerances.h"

namespace percale {
namespace {

/// The slope beyond the minimum, over the first slope's size, up to which a trial is accepted where the objective is not known or
/// flat to rounding. From 1 on: steps that overshoot oscillate for ever.
constexpr double curvature_constant = 0.9;

/// Armijo constant: the fraction of the first slope by which the objective has to fall. Towards 1: good steps are shortened.
constexpr double armijo_constant = 1e-4;

/// Fraction of the objective by which it may rise and count as flat. 0: rounding refuses the last steps of a solve.
constexpr double flat_objective = 1e-9;

/// The smallest and the largest factor of the next trial, and the one where the secant gives none.
constexpr double min_shortening = 0.15, max_shortening = 0.6, blind_shortening = 0.5;

/// Fraction of newton_error_ratio: a line that was cut is the solution only where its whole direction changes so little. 0: taut
/// cloth, some of which turns between sticking and sliding, takes hundreds of iterations. 1: cloth at rest may tremble.
constexpr double tiny_ratio = 0.1;

/// Relative. Smaller moves are rounding of positions (a few units in the last place of a double).
constexpr double position_rounding = 1e-15;

/// One line: functions that share its direction and its points.
class Line {
public:
    Line(StageEquations& equations, const LineTask& task, StagePoint& current, StagePoint& trial)
        : equations_(equations),
          stage_(equations.stage()),
          task_(task),
          current_(current),
          trial_(trial),
          was_arrived_(equations.arrived(current)) {}

    LineResult search() {
        equations_.move(current_, task_.direction, 1.0, trial_);
        mark_small();
        result_.stuck = result_.small && was_arrived_ && moves_nothing();
        line_ = {.start_objective = current_.objective, .start_slope = slope_at(current_)};
        double fraction = 1.0, kept = 1.0;
        for (int trial = 0; trial < max_line_trials; ++trial) {
            if (trial > 0) equations_.move(current_, task_.direction, fraction, trial_);
            kept = evaluate_trial();
            line_.objective_known = !equations_.damps_velocity() && current_.constraints.size() + trial_.constraints.size() == 0;
            // While pins or obstacles are on their way, the objective may have to rise.
            if (!stage_.options.line_search || !was_arrived_ || accept_trial(fraction * kept, line_)) break;
            fraction *= kept * shorten(line_);
            ++result_.backtracks;
        }
        std::swap(current_, trial_);
        result_.full_step = fraction * kept == 1.0 && was_arrived_;
        return result_;
    }

private:
    double slope_at(const StagePoint& point) const { return dot(stage_.scene.compute, point.residual, task_.direction); }

    /// Marks the bodies that the whole direction, to trial_, changes by little.
    void mark_small() {
        const ClothModel& model = stage_.scene.model;
        const NewtonChange change{current_.residual, task_.direction, trial_.velocities, current_.constraints.size() > 0};
        const double error_ratio = allowed_error_ratio(stage_.scene.settings);
        const auto is_small = [&](double ratio) {
            return [&, ratio](const Body& body) { return change_is_small(task_.error, change, ratio * error_ratio, body); };
        };
        result_.small = task_.bodies.mark(model, is_small(1.0));
        result_.tiny = result_.small && was_arrived_ && task_.bodies.all_small(model, is_small(tiny_ratio));
    }

    /// Whether the whole direction moves no vertex by more than the rounding of positions: the residual is then rounding, too.
    bool moves_nothing() const {
        const auto largest = [&](const Vec3Arrays& vectors) {
            return largest_term(stage_.scene.compute, 0, stage_.scene.model.vertex_count(),
                                [&](int i) { return square_at(vectors, i); });
        };
        const double moved = stage_.base.h * std::sqrt(largest(task_.direction));
        return moved <= position_rounding * std::sqrt(largest(current_.positions));
    }

    /// Clamps the trial and computes its forces; returns the fraction of the move that was kept.
    double evaluate_trial() {
        const double kept = equations_.clamp(current_, trial_);
        equations_.evaluate(trial_, &current_);
        line_.objective = trial_.objective;
        line_.slope = slope_at(trial_);
        return kept;
    }

    StageEquations& equations_;
    const ImplicitStage& stage_;
    const LineTask& task_;
    StagePoint &current_, &trial_;
    bool was_arrived_;
    LineTrial line_;
    LineResult result_;
};

}  // namespace

bool accept_trial(double fraction, const LineTrial& trial) {
    if (!std::isfinite(trial.objective) || !std::isfinite(trial.slope)) return false;
    const bool gentle = trial.slope <= curvature_constant * std::abs(trial.start_slope);
    if (!trial.objective_known) return gentle;
    if (trial.objective <= trial.start_objective + armijo_constant * fraction * trial.start_slope) return true;
    const bool flat = trial.objective <= trial.start_objective + flat_objective * std::abs(trial.start_objective);
    return flat && gentle;
}

double shorten(const LineTrial& trial) {
    const double rise = trial.slope - trial.start_slope;
    if (!(rise > 0.0) || !std::isfinite(rise)) return blind_shortening;
    return std::clamp(-trial.start_slope / rise, min_shortening, max_shortening);
}

LineResult search_line(StageEquations& equations, const LineTask& task, StagePoint& current, StagePoint& trial) {
    return Line(equations, task, current, trial).search();
}

}  // namespace percale
