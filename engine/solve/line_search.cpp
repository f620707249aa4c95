#include "line_search.h"

#include <algorithm>
#include <cmath>

#include "tolerances.h"

namespace percale {
namespace {

/// Strong Wolfe constant: the slope beyond the minimum, over the first slope's size, up to which a step is accepted whatever the
/// objective is: friction is not in it, and steps that overshoot by more oscillate for ever. It is smaller where contact is
/// projected, unless the step changes little: constraints that were in no matrix stop the cloth half-way, and the next step
/// would lead back as far.
constexpr double strong_wolfe_constant = 0.9, max_projected_slope = 0.3;

/// The strong Wolfe constant where the objective is flat to rounding or not known, and the slope decides.
constexpr double gentle_slope = 0.9;

/// Armijo constant: the fraction of the first slope by which the objective has to fall. Towards 1: good steps are shortened.
constexpr double armijo_constant = 1e-4;

/// Fraction of the objective by which it may rise and count as flat. 0: rounding refuses the last steps of a solve.
constexpr double flat_objective = 1e-9;

/// Slope over the objective below which slopes are rounding. 0: a search at the solution never ends.
constexpr double flat_slope = 1e-12;

/// The smallest and the largest factor of the next trial, and the one where the secant gives none.
constexpr double min_shortening = 0.15, max_shortening = 0.6, blind_shortening = 0.5;

/// Fraction of the first slope that is left after a full step, from which on a longer step pays for its evaluation.
constexpr double slope_left_ratio = 0.6;

/// The longest step by the secant, and the smallest relative fall of the slope by which the secant divides.
constexpr double longest_secant_step = 3.0, min_secant_fall = 0.1;

/// Fraction of a slope that has turned which trial contacts, out of range until then, must cause: then a new direction is found
/// with them in the matrix. Larger: the step is shortened instead, again and again while sheets land. Smaller: directions are
/// found in vain.
constexpr double trial_slope_ratio = 0.5;

/// Fraction of newton_error_ratio: a line that was cut is the solution only where its whole direction changes so little. 0: taut
/// cloth, some of which turns between sticking and sliding, takes hundreds of iterations. 1: cloth at rest may tremble.
constexpr double tiny_ratio = 0.1;

/// Relative. Smaller moves are rounding of positions (a few units in the last place of a double).
constexpr double position_rounding = 1e-15;

bool is_flat(const LineTrial& line) { return std::abs(line.start_slope) <= flat_slope * std::abs(line.start_objective); }

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
        const bool rounding = result_.small && was_arrived_ && moves_nothing();
        begin();
        double fraction = 1.0, kept = 1.0;
        bool accepted = false;
        for (int trial = 0; trial < max_line_trials; ++trial) {
            if (trial > 0) equations_.move(current_, task_.direction, fraction, trial_);
            kept = evaluate_trial();
            line_.objective_known = !equations_.damps_velocity() && current_.constraints.size() + trial_.constraints.size() == 0;
            // While pins or obstacles are on their way, the objective may have to rise.
            accepted = !stage_.options.line_search || !was_arrived_ || accept_trial(fraction * kept, line_);
            if (accepted) break;
            result_.met_contacts = trial == 0 && task_.trial_contacts && kept == 1.0 && meets_contacts();
            if (result_.met_contacts) return result_;
            fraction *= kept * shorten(line_);
            ++result_.backtracks;
        }
        std::swap(current_, trial_);
        result_.full_step = fraction * kept == 1.0 && was_arrived_;
        result_.stuck = rounding || (!accepted && was_arrived_ && is_flat(line_));
        if (accepted && result_.full_step && !result_.small) result_.went_on = go_on();
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

    void begin() {
        line_ = {.start_objective = current_.objective, .start_slope = slope_at(current_)};
        const bool may_turn = stage_.scene.settings.newton_iterations == 1 || current_.constraints.size() == 0 || is_flat(line_);
        if (!may_turn)
            line_.curvature_constant = stage_.projects() && !result_.small ? max_projected_slope : strong_wolfe_constant;
    }

    /// Clamps the trial and computes its forces; returns the fraction of the move that was kept.
    double evaluate_trial() {
        const double kept = equations_.clamp(current_, trial_);
        equations_.evaluate(trial_, &current_);
        line_.objective = trial_.objective;
        line_.slope = slope_at(trial_);
        return kept;
    }

    /// Whether the whole direction is too long because of contacts that were out of range at its start: they make most of the
    /// slope at its end.
    bool meets_contacts() const {
        if (!(line_.slope > 0.0)) return false;
        const TrialMove move{trial_.constraints, trial_.constraint_forces, current_.positions, task_.direction,
                             stage_.base.h,      stage_.contact_weight};
        const double slope = find_trial_contacts(current_.contact.blocks, move, *task_.trial_contacts);
        return slope >= trial_slope_ratio * line_.slope;
    }

    /// A clamped matrix is too stiff where cloth buckles or begins to slide: the slope then hardly falls over a full step, and
    /// the secant's extension along the same direction costs only an evaluation.
    bool go_on() {
        const double ratio = line_.slope / line_.start_slope;
        if (!(ratio > slope_left_ratio) || !stage_.options.line_search || stage_.scene.settings.newton_iterations == 1)
            return false;
        const double further = std::min(ratio / std::max(1.0 - ratio, min_secant_fall), longest_secant_step);
        line_.start_objective = line_.objective;
        line_.start_slope = line_.slope;
        equations_.move(current_, task_.direction, further, trial_);
        const double kept = evaluate_trial();
        if (accept_trial(further * kept, line_)) std::swap(current_, trial_);
        return true;
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
    if (trial.slope > trial.curvature_constant * std::abs(trial.start_slope)) return false;
    const bool gentle = trial.slope <= gentle_slope * std::abs(trial.start_slope);
    if (trial.objective <= trial.start_objective + armijo_constant * fraction * trial.start_slope) return true;
    if (!trial.objective_known) return gentle;
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
