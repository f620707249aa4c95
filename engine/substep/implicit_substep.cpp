#include "implicit_substep.h"

#include <algorithm>
#include <numbers>

#include "impacts.h"
#include "ledger.h"
#include "schemes/schemes.h"
#include "state_forces.h"
#include "targets.h"

namespace percale {
namespace {

SubstepOutcome substep_outcome(NewtonEnd end) {
    switch (end) {
        case NewtonEnd::converged:
            return SubstepOutcome::solved;
        case NewtonEnd::iterations_used:
            return SubstepOutcome::not_converged;
        case NewtonEnd::blocked:
            return SubstepOutcome::blocked;
        default:
            return SubstepOutcome::not_finite;
    }
}

/// One substep by one scheme: the stages, and their results so far.
class ImplicitSubstep {
public:
    ImplicitSubstep(const Substep& substep, const StepState& start, Workspace& work, StepState& end)
        : substep_(substep), scene_(substep.scene), start_(start), work_(work), end_(end) {}

    SubstepResult run() {
        begin_end(start_, end_);
        make_stages();
        if (!usable()) return result_;
        set_rest_length(substep_, start_, work_.rest_length, end_.cloth);
        account_implicit(substep_, {start_, end_, middle_, obstacle_work_}, work_, result_.flows);
        if (scene_.plan.scheme == Scheme::backward_euler) settle_end();
        return result_;
    }

private:
    void make_stages() {
        switch (scene_.plan.scheme) {
            case Scheme::implicit_midpoint:
                return make_midpoint();
            case Scheme::trapezoid:
                return make_trapezoid();
            case Scheme::bdf2:
                return make_bdf2();
            case Scheme::tr_bdf2:
                return make_tr_bdf2();
            default:
                return make_backward_euler();
        }
    }

    bool usable() const { return result_.is_usable(substep_.last_try); }
    double length() const { return substep_.length(); }

    /// A stage of the substep: its start, and its part of the step.
    struct Part {
        const ClothState& from;
        StepFraction fraction;
        double contact_weight = 1.0;
    };
    Part whole() const { return {start_.cloth, substep_.fraction}; }

    /// Solves work_.base; returns the estimated error of time, m.
    double solve(const Part& part, ClothState& to) {
        const ImplicitStage stage{.scene = scene_,
                                  .base = work_.base,
                                  .start = part.from,
                                  .targets = work_.targets,
                                  .substep = part.fraction,
                                  .contact_weight = part.contact_weight,
                                  .obstacle_motions = work_.obstacle_motions,
                                  .wind = set_wind_at(scene_, part.from.positions, work_),
                                  .rest_length = rest_lengths_at(substep_, seam_place_, start_, work_.rest_length)};
        const NewtonReport report = solve_stage(stage, work_.newton, {to, end_.contact}, work_.times);
        add(report);
        return report.time_error;
    }

    void aim_at(const Part& part) {
        set_targets(substep_, part.fraction.to, work_.targets);
        set_obstacle_motions(scene_, part.fraction.from, work_.obstacle_motions);
    }

    /// Solves a stage whose prescribed vertices move at a steady speed.
    double solve_steadily(const Part& part, ClothState& to) {
        aim_at(part);
        const double length = scene_.settings.time_step * (part.fraction.to - part.fraction.from);
        set_prescribed_base(scene_.script.free, part.from.positions, work_.targets, length, work_.base);
        return solve(part, to);
    }

    void add(const NewtonReport& stage) {
        result_.newton_iterations += stage.newton_iterations;
        result_.linear_iterations += stage.linear_iterations;
        result_.line_search_cuts += stage.line_search_cuts;
        result_.out_of_time = result_.out_of_time || stage.out_of_time;
        result_.residual = stage.residual;
        result_.smallest_fraction = std::min(result_.smallest_fraction, stage.smallest_fraction);
        result_.contact_stiffness = std::max(result_.contact_stiffness, stage.largest_stiffness);
        const SubstepOutcome end = substep_outcome(stage.end);
        if (end != SubstepOutcome::solved) result_.end = end;  // a later stage may still have converged
    }

    void set_start_accelerations() {
        const ClothState& cloth = start_.cloth;
        const std::span<const double> rest_length = rest_lengths_at(substep_, 0.0, start_, work_.rest_length);
        set_accelerations(scene_, {cloth.positions, cloth.velocities, cloth.positions, rest_length}, work_, work_.acceleration);
    }

    /// The old acceleration of the trapezoid, M a = f + the residual of the last solve. Without that residual, stiff springs
    /// would answer an error e of the solver's positions by (w h)^2 e, and again in each step.
    void set_old_accelerations() {
        set_start_accelerations();
        const Vec3Arrays& unbalanced = start_.past.unbalanced;
        if (unbalanced.padded_size() == 0) return;
        for (int i = 0; i < scene_.model.vertex_count(); ++i) {
            if (scene_.is_free(i)) work_.acceleration.add(i, unbalanced.at(i) / scene_.model.mass[i]);
        }
    }

    /// (v - v*)/h of a stage's end.
    void set_end_acceleration(const ClothState& end, Vec3Arrays& acceleration) const {
        acceleration.resize(scene_.model.vertex_count());
        set_extrapolated(acceleration, 1.0 / work_.base.h, end.velocities, work_.base.velocities, acceleration);
    }

    void keep_unbalanced() {
        end_.past.unbalanced.resize(scene_.model.vertex_count());
        add_scaled(end_.past.unbalanced, 1.0 / work_.base.h, work_.newton.current.residual);
    }

    /// Whether the substep begins with a vertex of the body in an impact.
    bool is_in_impact(const Body& body) const {
        const std::vector<Impact>& impacts = start_.cloth.impacts;
        const auto first = std::lower_bound(impacts.begin(), impacts.end(), body.first,
                                            [](const Impact& impact, int vertex) { return impact.vertex < vertex; });
        return first != impacts.end() && first->vertex < body.first + body.count;
    }

    /// For backward Euler in contact: the residual momentum of the last solve in each body that nothing holds comes back with
    /// the other sign, so that residuals do not add up from step to step. It does not in an impact: the residual of a hard
    /// contact there is no momentum that the body lacks.
    void return_unbalanced() {
        const Vec3Arrays& unbalanced = start_.past.unbalanced;
        if (unbalanced.padded_size() == 0) return;
        for (const Body& body : scene_.model.bodies) {
            const int last = body.first + body.count;
            Vec3 force = Vec3::Zero();
            bool held = is_in_impact(body);
            for (int i = body.first; i < last; ++i) {
                force += unbalanced.at(i);
                held = held || !scene_.is_free(i);
            }
            if (held) continue;
            for (int i = body.first; i < last; ++i) work_.base.velocities.add(i, -length() / body.mass * force);
        }
    }

    /// Work of the obstacles by the contacts of the stage just solved, over a length in s.
    double obstacle_work(double length) const {
        return scene_.plan.contacts ? length * work_.newton.current.contact.obstacle_power : 0.0;
    }

    void make_backward_euler() {
        aim_at(whole());
        set_euler_base(start_.cloth, length(), work_.base);
        if (scene_.plan.contacts) return_unbalanced();
        result_.error = solve(whole(), end_.cloth);
        if (scene_.plan.contacts && usable()) keep_unbalanced();
        obstacle_work_ = obstacle_work(work_.base.h);
    }

    void make_midpoint() {
        set_start_accelerations();
        set_midpoint_base(start_.cloth, work_.acceleration, length(), work_.base);
        seam_place_ = 0.5;
        const double middle = 0.5 * (substep_.fraction.from + substep_.fraction.to);
        result_.error = 2.0 * solve_steadily({start_.cloth, {substep_.fraction.from, middle}}, end_.cloth);
        if (result_.end == SubstepOutcome::not_finite || result_.end == SubstepOutcome::blocked) return;
        ClothState& end = end_.cloth;
        const ClothState& start = start_.cloth;
        set_extrapolated(end.positions, 1.0, end.positions, start.positions, end.positions);
        set_extrapolated(end.velocities, 1.0, end.velocities, start.velocities, end.velocities);
        set_targets(substep_, substep_.fraction.to, work_.targets);
        for (int i = 0; i < scene_.model.vertex_count(); ++i) {
            if (scene_.is_free(i)) continue;
            end.positions.set(i, work_.targets.at(i));
            end.velocities.set(i, (work_.targets.at(i) - start.positions.at(i)) / length());
        }
        update_points(end);
    }

    void make_trapezoid() {
        set_old_accelerations();
        set_trapezoid_base(start_.cloth, work_.acceleration, length(), work_.base);
        result_.error = solve_steadily(whole(), end_.cloth);
        if (usable()) keep_unbalanced();
    }

    void make_tr_bdf2() {
        ClothState& middle = work_.middle;
        middle_ = &middle;
        const double first = trapezoid_fraction * length(), between = substep_.at(trapezoid_fraction);
        set_old_accelerations();
        set_trapezoid_base(start_.cloth, work_.acceleration, first, work_.base);
        seam_place_ = trapezoid_fraction;
        solve_steadily({start_.cloth, {substep_.fraction.from, between}, 2.0}, middle);
        if (!usable()) return;
        const double kept = length() - work_.base.h;  // s, in which forces of the first stage act in total
        settle({.contacts = work_.newton.current,
                .start = start_.cloth,
                .length = first,
                .impulse_time = first,
                .keeps_to_mean = true,
                .weight = kept / first},
               middle);
        obstacle_work_ += obstacle_work(kept);
        set_end_acceleration(middle, work_.acceleration);
        set_bdf2_base(middle, work_.acceleration, start_.cloth, length() - first, first, work_.base);
        stop_at_jumps(middle);
        seam_place_ = 1.0;
        solve_steadily({middle, {between, substep_.fraction.to}}, end_.cloth);
        if (!usable()) return;
        if (scene_.settings.adaptive) result_.error = companion_error();
        settle({work_.newton.current, middle, length() - first, work_.base.h, true, &work_.base.velocities}, end_.cloth);
        obstacle_work_ += obstacle_work(work_.base.h);
        keep_unbalanced();
        // The residual of a hard contact at a vertex in an impact is no force that the next step begins with.
        for (const Impact& impact : end_.cloth.impacts) end_.past.unbalanced.set(impact.vertex, Vec3::Zero());
    }

    ImpactEnergy settle_with_impulses(const StageMove& move, ClothState& end) {
        add_contact_impulses(move.contacts, move.weight * move.impulse_time, end_.impulses);
        return settle_impacts(scene_, move, end, work_.impacts, end_.impulses);
    }

    /// Settles impacts; the account counts the change of energy as contact's.
    void settle(const StageMove& move, ClothState& end) {
        if (scene_.plan.contacts) obstacle_work_ += settle_with_impulses(move, end).work;
    }

    /// A velocity that has jumped is not extrapolated from its value before.
    void stop_at_jumps(const ClothState& from) {
        if (!scene_.plan.contacts) return;
        for (const auto& [vertex, obstacle, direction] : work_.impacts.jumps) {
            const Vec3 beyond = work_.base.velocities.at(vertex) - from.velocities.at(vertex);
            const Vec3 change = -direction.dot(beyond) * direction;
            work_.base.velocities.add(vertex, change);
            if (obstacle < 0 || end_.impulses.empty() || !scene_.is_free(vertex)) continue;
            end_.impulses[obstacle].take(from.positions.at(vertex), scene_.model.mass[vertex] * change);
        }
    }

    /// Settles impacts for backward Euler, after its account: velocities are those of the positions until then.
    void settle_end() {
        if (!scene_.plan.contacts) return;
        const ImpactEnergy flows = settle_with_impulses({work_.newton.current, start_.cloth, length(), length()}, end_.cloth);
        result_.flows.work += flows.work;
        if (scene_.plan.ledger) result_.flows.dissipated_contact += flows.loss;
    }

    /// Compares with the companion of third order with the weights (1 - w)/3, w + 1/3, g/6 instead of w, w, g/2, w = sqrt 2/4.
    double companion_error() {
        constexpr double w = std::numbers::sqrt2 / 4.0;
        Vec3Arrays& error = work_.scratch;
        error.resize(scene_.model.vertex_count());
        add_scaled(error, length() * (4.0 * w - 1.0) / 3.0, start_.cloth.velocities);
        add_scaled(error, -length() / 3.0, work_.middle.velocities);
        add_scaled(error, length() * trapezoid_fraction / 3.0, end_.cloth.velocities);
        return mean_size(scene_, error);
    }

    /// BDF2 begins with a step of TR-BDF2, which is of second order and needs no earlier state.
    void make_bdf2() {
        const SchemeHistory& past = start_.past;
        if (past.earlier_length == 0.0) {
            make_tr_bdf2();
        } else {
            set_bdf2_base(start_.cloth, past.acceleration, past.earlier, length(), past.earlier_length, work_.base);
            result_.error = solve_steadily(whole(), end_.cloth);
        }
        if (!usable()) return;
        set_end_acceleration(end_.cloth, end_.past.acceleration);
        end_.past.earlier.positions = start_.cloth.positions;
        end_.past.earlier.velocities = start_.cloth.velocities;
        end_.past.earlier_length = length();
    }

    const Substep& substep_;
    const StepScene& scene_;
    const StepState& start_;
    Workspace& work_;
    StepState& end_;
    SubstepResult result_;
    const ClothState* middle_ = nullptr;  // between two stages
    double seam_place_ = 1.0;             // in the substep; its rest lengths hold for the coming stage
    double obstacle_work_ = 0.0;          // J
};

}  // namespace

SubstepResult advance_implicit(const Substep& substep, const StepState& start, Workspace& work, StepState& end) {
    return ImplicitSubstep(substep, start, work, end).run();
}

}  // namespace percale
