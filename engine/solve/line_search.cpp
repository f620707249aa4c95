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

/// Relative. Smaller moves are rounding of positions (a few units in the last place of a double).
constexpr double position_rounding = 1e-15;

double slope_at(const StageEquations& equations, const StagePoint& point) {
    return dot(equations.stage().scene.compute, point.residual, equations.space().direction);
}

bool is_flat(const LineTrial& line) { return std::abs(line.start_slope) <= flat_slope * std::abs(line.start_objective); }

LineTrial line_from(const StageEquations& equations, bool small) {
    const ImplicitStage& stage = equations.stage();
    const StagePoint& current = equations.space().current;
    LineTrial line{.start_objective = current.objective, .start_slope = slope_at(equations, current)};
    const bool may_turn = stage.scene.settings.newton_iterations == 1 || current.constraints.size() == 0 || is_flat(line);
    if (!may_turn) line.curvature_constant = stage.projects() && !small ? max_projected_slope : strong_wolfe_constant;
    return line;
}

/// Computes the forces at space.trial.
void evaluate_trial(StageEquations& equations, LineTrial& line) {
    NewtonSpace& space = equations.space();
    equations.evaluate(space.trial);
    line.objective = space.trial.objective;
    line.slope = slope_at(equations, space.trial);
}

/// Whether the whole direction is too long because of contacts that were out of range at its start: they make most of the slope
/// at its end.
bool meets_contacts(const StageEquations& equations, const LineTrial& line) {
    if (!(line.slope > 0.0)) return false;
    const ImplicitStage& stage = equations.stage();
    NewtonSpace& space = equations.space();
    const StagePoint &current = space.current, &trial = space.trial;
    const TrialMove move{trial.constraints, trial.constraint_forces, current.positions, space.direction,
                         stage.base.h,      stage.contact_weight};
    const double slope = find_trial_contacts(current.contact.blocks, move, space.trial_contacts);
    return slope >= trial_slope_ratio * line.slope;
}

/// Whether the whole direction moves no vertex by more than the rounding of positions: the residual is then rounding, too.
bool moves_nothing(const StageEquations& equations) {
    const NewtonSpace& space = equations.space();
    const int count = equations.stage().scene.model.vertex_count();
    const auto largest = [&](const Vec3Arrays& vectors) {
        return largest_term(equations.stage().scene.compute, 0, count, [&](int i) { return square_at(vectors, i); });
    };
    const double moved = equations.stage().base.h * std::sqrt(largest(space.direction));
    return moved <= position_rounding * std::sqrt(largest(space.current.positions));
}

/// A clamped matrix is too stiff where cloth buckles or begins to slide: the slope then hardly falls over a full step, and the
/// secant's extension along the same direction costs only an evaluation.
bool go_on(StageEquations& equations, LineTrial line) {
    const ImplicitStage& stage = equations.stage();
    const double ratio = line.slope / line.start_slope;
    if (!(ratio > slope_left_ratio) || !stage.options.line_search || stage.scene.settings.newton_iterations == 1) return false;
    const double further = std::min(ratio / std::max(1.0 - ratio, min_secant_fall), longest_secant_step);
    line.start_objective = line.objective;
    line.start_slope = line.slope;
    equations.aim(further);
    const double kept = equations.cut();
    evaluate_trial(equations, line);
    if (accept_trial(further * kept, line)) std::swap(equations.space().current, equations.space().trial);
    return true;
}

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

LineResult search_line(StageEquations& equations, const TimeError& error, bool stop_at_contacts) {
    const ImplicitStage& stage = equations.stage();
    NewtonSpace& space = equations.space();
    const bool was_arrived = equations.arrived();
    LineResult result;
    equations.aim(1.0);
    const NewtonChange change = change_to(equations, space.trial.velocities);
    const double error_ratio = allowed_error_ratio(stage.scene.settings);
    result.small =
        space.bodies.mark(stage.scene.model, [&](const Body& body) { return change_is_small(error, change, error_ratio, body); });
    const bool rounding = result.small && was_arrived && moves_nothing(equations);
    LineTrial line = line_from(equations, result.small);
    double fraction = 1.0, kept = 1.0;
    bool accepted = false;
    for (int trial = 0; trial < max_line_trials; ++trial) {
        if (trial > 0) equations.aim(fraction);
        kept = equations.cut();
        evaluate_trial(equations, line);
        line.objective_known =
            !space.springs.velocity_damping && space.current.constraints.size() + space.trial.constraints.size() == 0;
        // While pins or obstacles are on their way, the objective may have to rise.
        accepted = !stage.options.line_search || !was_arrived || accept_trial(fraction * kept, line);
        if (accepted) break;
        result.met_contacts = trial == 0 && stop_at_contacts && kept == 1.0 && meets_contacts(equations, line);
        if (result.met_contacts) return result;
        fraction *= kept * shorten(line);
        ++result.backtracks;
    }
    std::swap(space.current, space.trial);
    result.full_step = fraction * kept == 1.0 && was_arrived;
    result.stuck = rounding || (!accepted && was_arrived && is_flat(line));
    if (accepted && result.full_step && !result.small) result.went_on = go_on(equations, line);
    return result;
}

}  // namespace percale
