#include "newton.h"

#include <algorithm>
#include <cmath>
#include <optional>

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

/// Rounds of contact multipliers in one stage. Fewer: projected contact is left inexact.
constexpr int max_contact_rounds = 6;

/// Largest error of contact, fraction of h: contact less exact takes another round, however large the time error is.
constexpr double contact_round_ratio = 0.01;

/// The state of the search for a motion.
struct Search {
    std::optional<double> first_norm;    // the reference of residuals, in all rounds of contact correction
    double norm = 0.0, last_norm = 0.0;  // of the residual now and one iteration ago, m/s kg^1/2
    bool matrix_is_old = false;          // the line search went beyond the point to which the matrix led
    bool line_solved = false;            // the last line searched ended at the solution
};

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

void measure_residual(const StageEquations& equations, Search& search, NewtonReport& report) {
    const ImplicitStage& stage = equations.stage();
    search.norm = residual_norm(stage.scene, equations.space().current.residual);
    if (!search.first_norm) search.first_norm = std::max(search.norm, gravity_norm(stage));
    report.residual = *search.first_norm == 0.0 ? 0.0 : search.norm / *search.first_norm;
}

/// Whether another iteration would change little, estimated by applying the preconditioner to the residual: far cheaper than the
/// iteration.
bool next_change_is_small(const StageEquations& equations, const TimeError& error, const Search& search,
                          const NewtonReport& report) {
    const bool by_residual = equations.stage().scene.settings.newton_tolerance.has_value();
    if (report.newton_iterations == 0 || by_residual || !equations.arrived() || search.matrix_is_old) return false;
    if (!estimate_direction(equations)) return false;
    const NewtonChange change = change_to(equations, equations.space().current.velocities);
    const double error_ratio = estimate_safety * allowed_error_ratio(equations.stage().scene.settings);
    return equations.space().bodies.all_small(
        equations.stage().scene.model, [&](const Body& body) { return change_is_small(error, change, error_ratio, body); });
}

bool meets_tolerance(const StageEquations& equations, const NewtonReport& report) {
    const std::optional<double>& tolerance = equations.stage().scene.settings.newton_tolerance;
    return tolerance && equations.arrived() && report.residual <= *tolerance;
}

/// Whether the line just searched ended at the solution: it changed little, but not in the first iteration, whose matrix may be
/// far off; or it can gain nothing but rounding. It may be the solution for some bodies while others go on.
bool is_solution(const StageEquations& equations, const Direction& direction, const LineResult& line, int iterations) {
    const bool by_residual = equations.stage().scene.settings.newton_tolerance.has_value();
    const bool may_settle = line.full_step && !line.went_on && direction.exact && !by_residual && iterations > 1;
    if (may_settle) equations.space().bodies.settle_small();
    return (may_settle && line.small) || line.stuck;
}

bool descends(const StageEquations& equations) {
    const NewtonSpace& space = equations.space();
    return dot(equations.stage().scene.compute, space.current.residual, space.direction) < 0.0;
}

/// Newton's method with fixed contact multipliers: from space.current, solves A dv = -r, then moves along dv as far as this
/// lowers the objective and crosses nothing (Nocedal and Wright, Numerical Optimization, chapters 3 and 7). True once the motion
/// is solved; false where it is given up, and at a residual of exactly 0.
bool find_motion(StageEquations& equations, const TimeError& error, Search& search, NewtonReport& report) {
    const StepSettings& settings = equations.stage().scene.settings;
    NewtonSpace& space = equations.space();
    search.line_solved = false;
    bool relaxed = false;
    space.bodies.start(equations.stage().scene.model);
    for (;;) {
        space.bodies.release_joined(equations.stage().scene.model, space.current.constraints);
        measure_residual(equations, search, report);
        if (search.norm == 0.0 || !std::isfinite(search.norm)) return false;
        if (meets_tolerance(equations, report)) return true;
        if (report.newton_iterations >= std::min(settings.newton_iterations, space.iterations_left)) return false;
        if (next_change_is_small(equations, error, search, report)) return true;
        if (is_cancelled(space.time.deadline)) return false;
        if (report.newton_iterations > 0 && is_past(space.time.deadline) &&
            (equations.arrived() || --space.time.late_iterations < 0)) {
            report.out_of_time = true;
            return false;
        }

        // Once an iteration: the result is examined anew, but not by a matrix that was filled in for a subset.
        relaxed = !relaxed && report.newton_iterations >= iterations_before_subsets && solve_subsets(equations, error);
        search.matrix_is_old = search.matrix_is_old || relaxed;
        if (relaxed) continue;
        const double ratio = report.newton_iterations > 0 ? search.norm / search.last_norm : 1.0;
        const NewtonProgress progress{report.newton_iterations, ratio, report.residual};
        const Vec3Arrays& velocities = space.current.velocities;
        SolveTarget target = solve_target(error, progress, settings, velocities);
        target.deadline = later(space.time.deadline, linear_grace_s);  // an interrupted solve gives a bad direction
        Direction direction = newton_direction(equations, target);
        const bool may_stop = equations.arrived() && report.newton_iterations + 1 < settings.newton_iterations;
        LineResult line = search_line(equations, error, may_stop);
        if (line.met_contacts) {
            ++report.newton_iterations;
            report.linear_iterations += direction.linear_iterations;
            space.first_direction = space.direction;
            const Direction with_trial_contacts = newton_direction(equations, target, &space.trial_contacts);
            // Contacts out of range are not in the residual yet: the move to where they hold the cloth may lead uphill.
            if (descends(equations)) {
                direction = with_trial_contacts;
            } else {
                std::swap(space.direction, space.first_direction);
                direction.linear_iterations = with_trial_contacts.linear_iterations;
            }
            line = search_line(equations, error);
        }

        ++report.newton_iterations;
        report.linear_iterations += direction.linear_iterations;
        report.line_search_cuts += line.backtracks;
        search.last_norm = search.norm;
        search.matrix_is_old = line.went_on;
        search.line_solved = is_solution(equations, direction, line, report.newton_iterations);
        if (search.line_solved || settings.newton_iterations == 1) break;
    }
    measure_residual(equations, search, report);
    return search.line_solved;
}

/// Contact less exact than this, m, is corrected: a fraction of the time error h/2 sqrt(sum m |v - v_n|^2/sum m), within limits
/// that are fractions of the thickness.
double enough_contact(const ImplicitStage& stage, const TimeError& error, const Vec3Arrays& velocities) {
    const ClothModel& model = stage.scene.model;
    const double square = squared_error(error, 0, model.vertex_count(), velocities);
    const double time_error = 0.5 * stage.base.h * std::sqrt(square / total_mass(stage.scene));
    const double thickness = *std::min_element(model.thickness.begin(), model.thickness.end());
    return std::clamp(allowed_error_ratio(stage.scene.settings) * time_error, contact_accuracy * thickness,
                      contact_round_ratio * thickness);
}

bool correct_contact(StageEquations& equations, const TimeError& error) {
    if (!equations.stage().projects()) return false;
    return equations.correct_contact(enough_contact(equations.stage(), error, equations.space().current.velocities));
}

/// The end of a search that was given up, or whose residual is exactly 0.
NewtonEnd end_of(const StageEquations& equations, const Search& search, const NewtonReport& report) {
    if (!std::isfinite(report.residual)) return NewtonEnd::not_finite;
    if (!equations.arrived()) return NewtonEnd::blocked;
    // A linearised step is taken as it is, unless it leads farther from the solution.
    const bool linearised = equations.stage().scene.settings.newton_iterations == 1 && report.newton_iterations == 1;
    const bool good = search.norm == 0.0 || search.line_solved || (linearised && report.residual <= 1.0);
    return good ? NewtonEnd::converged : NewtonEnd::iterations_used;
}

/// Writes space.current to the end of the stage, with pins exactly at their targets.
void leave(const StageEquations& equations, StageEnd end) {
    const ImplicitStage& stage = equations.stage();
    const StagePoint& point = equations.space().current;
    copy(stage.scene.compute, point.positions, end.cloth.positions);
    copy(stage.scene.compute, point.velocities, end.cloth.velocities);
    for (int i = 0; i < stage.scene.model.vertex_count(); ++i) {
        if (!stage.scene.is_free(i) && equations.arrived()) end.cloth.positions.set(i, stage.targets.at(i));
    }
    if (stage.scene.plan.contacts) {
        set_stick_anchors(point.contact.friction_contacts, end.cloth.stick_anchors);
    } else {
        end.cloth.stick_anchors = stage.start.stick_anchors;
        end.cloth.impacts = stage.start.impacts;
    }
    end.cloth.points.resize(stage.start.points.size());
    copy_out(stage.scene.compute, end.cloth.positions, end.cloth.points);
    equations.end_contact(end.contact);
}

}  // namespace

NewtonReport solve_stage(const ImplicitStage& stage, NewtonSpace& space, StageEnd end, StageTimes& times) {
    StageEquations equations(stage, end.contact, space, times);
    const TimeError error = time_error_of(stage);
    space.first_direction.resize(stage.scene.model.vertex_count());
    if (stage.options.predict) equations.predict();
    equations.evaluate(space.current);

    NewtonReport report;
    Search search;
    bool solved = find_motion(equations, error, search, report);
    for (int round = 0; solved && round < max_contact_rounds && correct_contact(equations, error); ++round) {
        solved = find_motion(equations, error, search, report);
    }
    if (!solved) report.end = end_of(equations, search, report);
    if (!std::isfinite(space.current.objective)) report.end = NewtonEnd::not_finite;
    report.smallest_fraction = equations.smallest_fraction();
    report.largest_stiffness = equations.largest_stiffness();
    if (report.end == NewtonEnd::not_finite || report.end == NewtonEnd::blocked) return report;
    report.time_error = time_error(error, space.current.velocities);
    leave(equations, end);
    return report;
}

}  // namespace percale
