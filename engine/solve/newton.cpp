#include "newton.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/contact_stiffness.h"
#include "direction.h"
#include "line_search.h"
#include "local_subsets.h"
#include "newton_stop.h"
#include "stage_equations.h"
#include "support/deadline.h"
#include "tolerances.h"

namespace percale {
namespace {

/// s beyond the time limit of a step that a linear solve may take. 0: a solve that ends at its first iteration gives velocities
/// of 50 m/s. Minutes: a step whose solve does not end exceeds the limit.
constexpr double linear_grace_s = 0.5;

/// Fraction of the allowed change (StepSettings::newton_error_ratio) where the change is only estimated. Larger: changes that
/// are not small count as small. Smaller: more iterations.
constexpr double estimate_safety = 0.4;

/// Newton iterations of a solve after which the nonlinear elimination of local subsets begins. Fewer: solves that soon end pay
/// for it. More: layers that slide on each other take two to three times as many.
constexpr int iterations_before_subsets = 8;

/// Halvings of a prediction that leads so far into contact that the objective rises. Fewer: Newton begins so high that it may
/// stop before it has come down to the energy at the start, and cloth that falls slowly is thrown off.
constexpr int max_prediction_halvings = 10;

/// Rounds of contact multipliers in one stage. Fewer: projected contact is left inexact.
constexpr int max_contact_rounds = 6;

/// Largest error of contact, fraction of h: contact less exact takes another round, however large the time error is.
constexpr double contact_round_ratio = 0.01;

/// |r| in velocity units weighted by mass: sqrt(sum |r_i|^2/m_i).
double residual_norm(const StepScene& scene, const Vec3Arrays& residual) {
    return std::sqrt(sum_terms(scene.compute, 0, scene.model.vertex_count(),
                               [&](int i) { return square_at(residual, i) / scene.model.mass[i]; }));
}

double total_mass(const StepScene& scene) {
    return sum_terms(scene.compute, 0, scene.model.vertex_count(), [&](int i) { return scene.model.mass[i]; });
}

/// The norm of the momentum that gravity gives in a stage: the reference of residuals in a scene at rest.
double gravity_norm(const ImplicitStage& stage) {
    return stage.base.h * stage.scene.settings.gravity.norm() * std::sqrt(total_mass(stage.scene));
}

/// Newton's method on one stage: functions that share its equations and its points.
class Newton {
public:
    Newton(StageEquations& equations, NewtonSpace& space)
        : equations_(equations),
          stage_(equations.stage()),
          scene_(stage_.scene),
          settings_(scene_.settings),
          error_(time_error_of(stage_)),
          space_(space),
          current_(space.current) {}

    NewtonReport run() {
        equations_.begin(current_, space_.trial, space_.direction.velocity);
        equations_.evaluate(current_, nullptr);
        for (int n = 0; n < max_prediction_halvings && equations_.starts_too_high(current_, space_.trial); ++n) {
            equations_.halve_prediction(space_.trial, current_);
            equations_.evaluate(current_, nullptr);
        }
        bool solved = find_motion();
        for (int round = 0; solved && round < max_contact_rounds && correct_contact(); ++round) solved = find_motion();
        if (!solved) report_.end = end_of_search();
        if (!std::isfinite(current_.objective)) report_.end = NewtonEnd::not_finite;
        report_.smallest_fraction = equations_.smallest_fraction();
        report_.largest_stiffness = equations_.largest_stiffness();
        if (may_be_left()) report_.time_error = time_error(error_, current_.velocities);
        return report_;
    }

    bool may_be_left() const { return report_.end != NewtonEnd::not_finite && report_.end != NewtonEnd::blocked; }

    /// Writes the end of the stage, with pins exactly at their targets.
    void leave(StageEnd end) const {
        copy(scene_.compute, current_.positions, end.cloth.positions);
        copy(scene_.compute, current_.velocities, end.cloth.velocities);
        for (int i = 0; i < scene_.model.vertex_count(); ++i) {
            if (!scene_.is_free(i) && arrived()) end.cloth.positions.set(i, stage_.targets.at(i));
        }
        if (scene_.plan.contacts) {
            set_stick_anchors(current_.contact.friction_contacts, end.cloth.stick_anchors);
        } else {
            end.cloth.stick_anchors = stage_.start.stick_anchors;
            end.cloth.impacts = stage_.start.impacts;
        }
        end.cloth.points.resize(stage_.start.points.size());
        copy_out(scene_.compute, end.cloth.positions, end.cloth.points);
        equations_.end_contact(current_, end.contact);
    }

private:
    /// Newton's method with fixed contact multipliers: solves A dv = -r, then moves along dv as far as this lowers the objective
    /// and crosses nothing (Nocedal and Wright, Numerical Optimization, chapters 3 and 7). True once the motion is solved; false
    /// where it is given up, and at a residual of exactly 0.
    bool find_motion() {
        line_solved_ = false;
        bool relaxed = false;
        space_.bodies.start(scene_.model);
        for (;;) {
            space_.bodies.release_joined(scene_.model, current_.constraints);
            measure_residual();
            if (norm_ == 0.0 || !std::isfinite(norm_)) return false;
            if (meets_tolerance()) return true;
            if (report_.newton_iterations >= std::min(settings_.newton_iterations, space_.iterations_left)) return false;
            // Not by a matrix that was filled in for a subset.
            if (!relaxed && next_change_is_small()) return true;
            if (is_out_of_time()) return false;

            // Once an iteration: the result is examined anew.
            relaxed = !relaxed && report_.newton_iterations >= iterations_before_subsets && relax_subsets();
            if (relaxed) continue;
            iterate();
            if (line_solved_ || settings_.newton_iterations == 1) break;
        }
        measure_residual();
        return line_solved_;
    }

    /// One iteration: a direction and a line.
    void iterate() {
        const double ratio = report_.newton_iterations > 0 ? norm_ / last_norm_ : 1.0;
        const NewtonProgress progress{report_.newton_iterations, ratio, report_.residual};
        SolveTarget target = solve_target(error_, progress, settings_, current_.velocities);
        target.deadline = later(space_.time.deadline, linear_grace_s);  // an interrupted solve gives a bad direction
        space_.system.find_direction(equations_, current_, {space_.bodies, target}, space_.direction);
        const LineTask task{error_, space_.direction.velocity, space_.bodies};
        const LineResult line = search_line(equations_, task, current_, space_.trial);
        ++report_.newton_iterations;
        report_.linear_iterations += space_.direction.linear_iterations;
        report_.line_search_cuts += line.backtracks;
        last_norm_ = norm_;
        line_solved_ = is_solution(line);
    }

    bool relax_subsets() {
        return solve_subsets(equations_, {error_, space_.bodies, space_.system, space_.direction, space_.time}, space_.subsets,
                             current_, space_.trial);
    }

    void measure_residual() {
        norm_ = residual_norm(scene_, current_.residual);
        if (!first_norm_) first_norm_ = std::max(norm_, gravity_norm(stage_));
        report_.residual = *first_norm_ == 0.0 ? 0.0 : norm_ / *first_norm_;
    }

    bool arrived() const { return equations_.arrived(current_); }
    bool by_residual() const { return settings_.newton_tolerance.has_value(); }
    bool meets_tolerance() const { return by_residual() && arrived() && report_.residual <= *settings_.newton_tolerance; }

    bool is_out_of_time() {
        if (is_cancelled(space_.time.deadline)) return true;
        // The matrix of the first iteration does not hold the contacts that its move meets.
        if (report_.newton_iterations < 2 || !is_past(space_.time.deadline)) return false;
        report_.out_of_time = arrived() || --space_.time.late_iterations < 0;
        return report_.out_of_time;
    }

    /// Whether another iteration would change little, estimated by applying the preconditioner to the residual: far cheaper than
    /// the iteration.
    bool next_change_is_small() {
        if (report_.newton_iterations == 0 || by_residual() || !arrived()) return false;
        if (!space_.system.estimate_direction(equations_, current_, space_.direction)) return false;
        const NewtonChange change{current_.residual, space_.direction.velocity, current_.velocities,
                                  current_.constraints.size() > 0};
        const double error_ratio = estimate_safety * allowed_error_ratio(settings_);
        return space_.bodies.all_small(scene_.model,
                                       [&](const Body& body) { return change_is_small(error_, change, error_ratio, body); });
    }

    /// Whether the line just searched changed the contact forces on no body by much. space_.trial is where it began.
    bool contact_is_settled() const {
        if (!scene_.plan.contacts) return true;
        const double gravity = contact_gravity(settings_.gravity);
        auto& [before, now] = space_.contact_accelerations;
        contact_accelerations(scene_.model, space_.trial, before);
        contact_accelerations(scene_.model, current_, now);
        for (std::size_t b = 0; b < now.size(); ++b) {
            if (!space_.bodies.settled(b) && !percale::contact_is_settled(before[b], now[b], gravity)) return false;
        }
        return true;
    }

    /// Whether the line just searched ended at the solution: it changed little, and contact forces, too, but not in the first
    /// iteration, whose matrix may be far off; or it can gain nothing but rounding. Of a line that was cut the whole direction
    /// has to be far smaller. It may be the solution for some bodies while others go on.
    bool is_solution(const LineResult& line) {
        const bool may_settle = (line.full_step || line.tiny) && space_.direction.exact && !by_residual() &&
                                report_.newton_iterations > 1 && contact_is_settled();
        if (may_settle) space_.bodies.settle_small();
        return (may_settle && line.small) || line.stuck;
    }

    /// Contact less exact than this, m, is corrected: a fraction of the time error h/2 sqrt(sum m |v - v_n|^2/sum m), within
    /// limits that are fractions of the thickness.
    double enough_contact() const {
        const ClothModel& model = scene_.model;
        const double square = squared_error(error_, 0, model.vertex_count(), current_.velocities);
        const double time_error = 0.5 * stage_.base.h * std::sqrt(square / total_mass(scene_));
        const double thickness = *std::min_element(model.thickness.begin(), model.thickness.end());
        return std::clamp(allowed_error_ratio(settings_) * time_error, contact_accuracy * thickness,
                          contact_round_ratio * thickness);
    }

    bool correct_contact() { return stage_.projects() && equations_.correct_contact(current_, enough_contact()); }

    /// The end of a search that was given up, or whose residual is exactly 0.
    NewtonEnd end_of_search() const {
        if (!std::isfinite(report_.residual)) return NewtonEnd::not_finite;
        if (!arrived()) return NewtonEnd::blocked;
        // A linearised step is taken as it is, unless it leads farther from the solution.
        const bool linearised = settings_.newton_iterations == 1 && report_.newton_iterations == 1;
        const bool good = norm_ == 0.0 || line_solved_ || (linearised && report_.residual <= 1.0);
        return good ? NewtonEnd::converged : NewtonEnd::iterations_used;
    }

    StageEquations& equations_;
    const ImplicitStage& stage_;
    const StepScene& scene_;
    const StepSettings& settings_;
    const TimeError error_;
    NewtonSpace& space_;
    StagePoint& current_;
    NewtonReport report_;
    std::optional<double> first_norm_;     // the reference of residuals, in all rounds of contact correction
    double norm_ = 0.0, last_norm_ = 0.0;  // of the residual now and one iteration ago, m/s kg^1/2
    bool line_solved_ = false;             // the last line searched ended at the solution
};

}  // namespace

NewtonReport solve_stage(const ImplicitStage& stage, NewtonSpace& space, StageEnd end, StageTimes& times) {
    space.system.begin_stage(stage);
    StageEquations equations(stage, end.contact, space.stage, space.system.solver.matrix, times);
    Newton newton(equations, space);
    const NewtonReport report = newton.run();
    if (newton.may_be_left()) newton.leave(end);
    return report;
}

}  // namespace percale
