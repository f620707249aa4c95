#include "newton.h"

#include <algorithm>
#include <cmath>

#include "line_search.h"
#include "newton_stop.h"
#include "support/stage_timer.h"

namespace percale {
namespace {

constexpr double share_of_time_error = 0.25;  // solver error over time error
constexpr double estimated_share = 0.1;       // likewise where the solver error is only estimated
constexpr int most_rounds = 6;                // of contact multipliers in one solve
constexpr double round_share = 0.01;          // of the thickness at most: contact less exact takes another round
constexpr int most_trials = 10;               // of one line search
/// Slopes beyond the minimum, over the first one's size, up to which a step is taken whatever the objective says: friction is not
/// in it, and steps that overshoot by more go to and fro for ever. Less where contact is projected, unless the step changes
/// little: rows that were in no matrix stop the cloth half-way, and the next step would lead back as far.
constexpr double most_turned = 0.9, most_projected = 0.3;
constexpr double slope_left = 0.6;  // of a full step, from where on going further pays for its evaluation

/// The solve of one part: functions that share the part, its work space and what is reported.
class NewtonSolve {
public:
    NewtonSolve(const ImplicitPart& part, NewtonSpace& space, StageTimes& stages)
        : part_(part), model_(*part.model), space_(space), stages_(stages) {}

    NewtonReport run(ClothState& state) {
        start(state);
        if (part_.options.predict) predict(state);
        evaluate(space_.current);
        iterate();
        if (!std::isfinite(space_.current.objective)) report_.end = NewtonEnd::not_finite;
        if (report_.end != NewtonEnd::not_finite && report_.end != NewtonEnd::blocked) finish(state);
        return report_;
    }

private:
    void start(const ClothState& state) {
        space_.start_positions = state.positions;
        space_.start_velocities = state.velocities;
        space_.current.positions = state.positions;
        space_.current.velocities = state.velocities;
        space_.current.points = space_.trial.points = state.points;
        base_positions_ = part_.base ? &part_.base->positions : &space_.start_positions;
        base_velocities_ = part_.base ? &part_.base->velocities : &space_.start_velocities;
        error_ = {.model = &model_,
                  .free = part_.free,
                  .dt = part_.dt,
                  .start = &space_.start_velocities,
                  .foreseen = part_.base ? &part_.base->foreseen : nullptr,
                  .foreseen_share = part_.base ? part_.base->error_share : 1.0};
        if (part_.settings->adaptive) error_.allowance = part_.settings->tolerance * part_.dt;
        space_.current.fraction = moves_are_scripted() ? part_.span.from : part_.span.to;
        space_.frozen_diagonal.padded = 0;
        if (!space_.solver.is_for(model_)) space_.solver.set_model(*part_.compute, model_, part_.settings->linear_solver);
        space_.solver.matrix.free = *part_.free;
        space_.solver.start_part();
        if (projects()) space_.projection.start_part();
        for (auto* vectors : {&space_.direction, &space_.right_side}) vectors->resize(model_.vertex_count());
        space_.start_grips = state.grips;
        space_.friction = {
            .positions = &space_.start_positions, .fraction = part_.span.from, .grips = space_.start_grips, .flows = part_.flows};
        set_step_springs(*part_.compute, {model_.adjacency, state.positions, part_.plan->damping, part_.dt}, space_.springs);
    }

    bool moves_are_scripted() const { return part_.plan->obstacles_move || part_.plan->pins_move; }
    bool arrived() const { return space_.current.fraction >= part_.span.to; }

    /// Free vertices go to q* + h v_n (without gravity: in the prediction it would press into the contact, and friction would
    /// then freeze everything), prescribed ones and obstacles to their ends, all cut where something would cross.
    void predict(const ClothState& state) {
        for (int i = 0; i < model_.vertex_count(); ++i) {
            const bool free = (*part_.free)[i] > 0.0;
            const Vec3 velocity =
                free ? state.velocities.at(i) : Vec3((part_.targets->at(i) - base_positions_->at(i)) / part_.dt);
            space_.direction.set(i, velocity);
        }
        // Velocities along the way are (q - q*)/h: what a cut takes from the move is not stored as energy.
        space_.current.velocities.resize(model_.vertex_count());
        if (part_.base) {
            set_extrapolated(space_.current.velocities, 1.0 / part_.dt, state.positions, *base_positions_,
                             space_.current.velocities);
            add_scaled(space_.direction, -1.0, space_.current.velocities);
        }
        move(1.0);
        if (part_.plan->contacts) {
            StageTimer timer(stages_.refresh);
            part_.detector->refresh(space_.current.points, space_.trial.points);
        }
        cut_move();
        std::swap(space_.current, space_.trial);
    }

    /// trial = current + fraction * direction, not yet cut.
    void move(double fraction) {
        NewtonPoint& trial = space_.trial;
        trial.velocities = space_.current.velocities;
        add_scaled(trial.velocities, fraction, space_.direction);
        place_trial();
        const double reached = space_.current.fraction;
        trial.fraction = fraction == 1.0 ? part_.span.to : reached + fraction * (part_.span.to - reached);
    }

    void place_trial() {
        NewtonPoint& trial = space_.trial;
        trial.positions = *base_positions_;
        add_scaled(trial.positions, part_.dt, trial.velocities);
        if (part_.plan->contacts) copy_out(trial.positions, trial.points);
    }

    /// Cuts the move from current to trial to what is proven free of crossing; returns the fraction kept.
    double cut_move() {
        if (!part_.plan->contacts) return 1.0;
        StageTimer timer(stages_.cut);
        NewtonPoint &current = space_.current, &trial = space_.trial;
        const StepFraction span{current.fraction, trial.fraction};
        const double fraction = part_.detector->largest_safe_fraction(current.points, trial.points, span);
        report_.smallest_fraction = std::min(report_.smallest_fraction, fraction);
        if (fraction >= 1.0) return 1.0;
        for (std::size_t i = 0; i < trial.velocities.padded_size(); ++i) {
            trial.velocities.x[i] = current.velocities.x[i] + fraction * (trial.velocities.x[i] - current.velocities.x[i]);
            trial.velocities.y[i] = current.velocities.y[i] + fraction * (trial.velocities.y[i] - current.velocities.y[i]);
            trial.velocities.z[i] = current.velocities.z[i] + fraction * (trial.velocities.z[i] - current.velocities.z[i]);
        }
        place_trial();
        if (moves_are_scripted()) trial.fraction = current.fraction + fraction * (span.to - span.from);
        return fraction;
    }

    ForceInput force_input(const NewtonPoint& point) const {
        return {.compute = part_.compute,
                .model = &model_,
                .springs = &space_.springs,
                .positions = &point.positions,
                .velocities = &point.velocities,
                .gravity = part_.settings->gravity,
                .wind = part_.wind,
                .dt = part_.dt,
                .with_matrix = true};
    }

    void evaluate(NewtonPoint& point) {
        if (part_.plan->contacts) {
            StageTimer timer(stages_.evaluate);
            part_.detector->evaluate(point.points, point.fraction, point.forces.rows);
        }
        StageTimer timer(stages_.force);
        evaluate_forces(force_input(point), point.forces);
        if (part_.plan->contacts) add_contacts(force_input(point), point);
        set_residual(point);
    }

    bool projects() const { return part_.plan->contacts && part_.settings->contact_response == ContactResponse::projection; }

    ContactStep contact_step(const NewtonPoint& point, bool first) const {
        return {.dt = contact_dt_,
                .stiffness_dt = part_.contact_dt,
                .obstacle_rate = 1.0 / part_.full_step,
                .fraction = point.fraction,
                .gravity = part_.settings->gravity,
                .mass = &model_.mass,
                .diagonal = &space_.frozen_diagonal,
                .load = &space_.frozen_load,
                .friction = &space_.friction,
                .previous = first ? nullptr : &space_.current.forces.contact.touches};
    }

    void add_contacts(const ForceInput& input, NewtonPoint& point) {
        Forces& forces = point.forces;
        const bool first = space_.frozen_diagonal.padded == 0;
        if (first) {
            fill_diagonal(space_.solver.matrix, forces.spring_terms, space_.frozen_diagonal, space_.frozen_inverse);
            space_.frozen_load = forces.total;
        }
        if (projects()) {
            if (first) space_.projection.meet(forces.rows);
            space_.projection.add(projected(point), projected_forces(point));
        } else {
            weigh_contact(1.0 / part_.contact_weight, forces);
            add_contact_forces(input, contact_step(point, first), forces);
            weigh_contact(part_.contact_weight, forces);
        }
        report_.largest_stiffness = std::max(report_.largest_stiffness, forces.contact.largest_stiffness);
    }

    /// Before and after contact is added, so that the factor of all others is 1.
    static void weigh_contact(double factor, Forces& forces) {
        if (factor == 1.0) return;
        for (auto* axis : {&forces.total.x, &forces.total.y, &forces.total.z}) {
            for (double& force : *axis) force *= factor;
        }
        forces.potential *= factor;
    }

    ProjectedPoint projected(const NewtonPoint& point) const {
        return {.step = contact_step(point, false),
                .rows = &point.forces.rows,
                .velocities = &point.velocities,
                .obstacles_moved = point.fraction - part_.span.from};
    }
    static ProjectedForces projected_forces(NewtonPoint& point) {
        return {point.forces.total, point.forces.contact, point.row_forces};
    }

    /// With the motion solved for, contact forces become multipliers: true if that leaves something to be solved.
    bool another_round() {
        if (!projects() || rounds_ == most_rounds || space_.current.forces.rows.size() == 0) return false;
        NewtonPoint& point = space_.current;
        const double time_error =
            0.5 * part_.dt * std::sqrt(squared_error(error_, 0, model_.vertex_count(), space_.current.velocities) / total_mass());
        const double thickness = *std::min_element(model_.thickness.begin(), model_.thickness.end());
        const double enough = std::clamp(share_of_time_error * time_error, smallest_share * thickness, round_share * thickness);
        if (space_.projection.mismatch(point.forces.rows, point.row_forces) <= enough) return false;
        StageTimer timer(stages_.force);
        ++rounds_;
        space_.projection.advance(projected(point), projected_forces(point));
        set_residual(point);
        return true;
    }

    /// r = M (v - v*) - h f and the incremental potential whose gradient by v it is.
    void set_residual(NewtonPoint& point) {
        if (point.residual.padded_size() != point.velocities.padded_size()) point.residual.resize(model_.vertex_count());
        const Vectors &force = point.forces.total, &velocity = point.velocities, &start = *base_velocities_;
        const double *free = part_.free->data(), *mass = model_.mass.data();
        const int count = model_.vertex_count();
        const double dt = part_.dt;
        const auto set_axis = [=](const double* f, const double* v, const double* v_start, double* r) {
            for (int i = 0; i < count; ++i) r[i] = free[i] * (mass[i] * (v[i] - v_start[i]) - dt * f[i]);
        };
        set_axis(force.x.data(), velocity.x.data(), start.x.data(), point.residual.x.data());
        set_axis(force.y.data(), velocity.y.data(), start.y.data(), point.residual.y.data());
        set_axis(force.z.data(), velocity.z.data(), start.z.data(), point.residual.z.data());
        point.objective = 0.5 * squared_distance(error_, velocity, start) + point.forces.potential;
    }

    /// |r| in velocity units weighted by mass: sqrt(sum |r_i|^2/m_i).
    double residual_norm() const {
        const Vectors& residual = space_.current.residual;
        return std::sqrt(sum_terms(0, model_.vertex_count(), [&](int i) { return square_at(residual, i) / model_.mass[i]; }));
    }

    void iterate() {
        const int most = part_.settings->newton_iterations;
        double first_norm = 0.0, last_norm = 0.0;
        for (int iteration = 0;; ++iteration) {
            const double norm = residual_norm();
            if (iteration == 0) first_norm = std::max(norm, gravity_norm());
            set_relative_residual(norm, first_norm);
            if (norm == 0.0 || !std::isfinite(norm)) return end_here(norm == 0.0);
            if (arrived() && part_.settings->newton_tolerance && report_.residual <= *part_.settings->newton_tolerance) {
                if (another_round()) continue;
                return;
            }
            if (iteration == most) break;
            if (iteration > 0 && estimate_is_small()) {
                if (another_round()) continue;
                converged_ = true;
                return;
            }
            solve_direction(iteration, norm, last_norm);
            last_norm = norm;
            ++report_.newton_iterations;
            if ((step_along() || another_round()) && most > 1) continue;
            set_relative_residual(residual_norm(), first_norm);
            // A linearised step is taken as it is, unless it leads farther from the solution.
            return end_here(most == 1 && report_.residual <= 1.0);
        }
        end_here(false);
    }

    void set_relative_residual(double norm, double first_norm) { report_.residual = first_norm > 0.0 ? norm / first_norm : 0.0; }

    /// The momentum that gravity gives in a step, as a norm: what a residual is measured against in a scene that is at rest.
    double gravity_norm() const { return part_.dt * part_.settings->gravity.norm() * std::sqrt(total_mass()); }

    double total_mass() const {
        return sum_terms(0, model_.vertex_count(), [&](int i) { return model_.mass[i]; });
    }

    void end_here(bool good_enough) {
        if (!std::isfinite(report_.residual)) {
            report_.end = NewtonEnd::not_finite;
        } else if (!arrived()) {
            report_.end = NewtonEnd::blocked;
        } else if (!good_enough && !converged_) {
            report_.end = NewtonEnd::iterations_used;
        }
    }

    /// direction = dv of the Newton system A dv = -r, prescribed vertices heading for their targets.
    void solve_direction(int iteration, double norm, double last_norm) {
        const NewtonPoint& point = space_.current;
        set_prescribed_direction();
        if (!part_.options.jacobians) return divide_by_mass();
        {
            StageTimer timer(stages_.setup);
            space_.solver.fill(point.forces.spring_terms, point.forces.contact.blocks);
            space_.right_side.resize(model_.vertex_count());
            add_scaled(space_.right_side, -1.0, point.residual);
            if (part_.plan->obstacles_move && !arrived()) {
                add_obstacle_advance(point.forces.rows, point.forces.contact, (part_.span.to - point.fraction) / part_.dt,
                                     *part_.free, space_.right_side);
            }
        }
        StageTimer timer(stages_.solve);
        const SolveTarget target = solve_target(error_, {iteration, iteration > 0 ? norm / last_norm : 1.0, report_.residual},
                                                part_.settings->newton_tolerance, point.velocities);
        const SolveReport solved = space_.solver.solve(space_.right_side, target, space_.direction);
        report_.linear_iterations += solved.iterations;
        direction_is_good_ = solved.converged;
        if (!part_.plan->wind && space_.current.forces.rows.size() == 0) correct_translation();
    }

    void set_prescribed_direction() {
        space_.direction.resize(model_.vertex_count());
        if (!part_.plan->pins_move || arrived()) return;
        for (int i = 0; i < model_.vertex_count(); ++i) {
            if ((*part_.free)[i] > 0.0) continue;
            space_.direction.set(i, (part_.targets->at(i) - space_.current.positions.at(i)) / part_.dt);
        }
    }

    /// Springs do not resist a translation, so the one left over by an unfinished linear solve is known exactly: with it, a cloth
    /// that nothing holds keeps its momentum whatever the tolerance.
    void correct_translation() {
        for (const Body& body : model_.bodies) {
            Vec3 missing = Vec3::Zero();
            bool held = false;
            for (int i = body.first; i < body.first + body.count; ++i) {
                held = held || (*part_.free)[i] == 0.0;
                missing -= space_.current.residual.at(i) + model_.mass[i] * space_.direction.at(i);
            }
            if (held) continue;
            for (int i = body.first; i < body.first + body.count; ++i) space_.direction.add(i, missing / body.mass);
        }
    }

    void divide_by_mass() {
        for (int i = 0; i < model_.vertex_count(); ++i) {
            if ((*part_.free)[i] > 0.0) space_.direction.set(i, -space_.current.residual.at(i) / model_.mass[i]);
        }
    }

    /// Line search and cut along the direction; false when the target is met or nothing more can be gained.
    bool step_along() {
        went_on_ = false;
        const double slope = dot(*part_.compute, space_.current.residual, space_.direction);
        const bool was_arrived = arrived();
        LineTrial line{.start_objective = space_.current.objective, .start_slope = slope};
        double fraction = 1.0, kept = 1.0;
        move(fraction);
        const bool small = is_small(space_.trial.velocities, share_of_time_error);
        const bool flat = std::abs(slope) <= 1e-12 * std::abs(line.start_objective);  // what slopes say then is rounding
        if (part_.settings->newton_iterations > 1 && space_.current.forces.rows.size() > 0 && !flat)
            line.most_turned = projects() && !small ? most_projected : most_turned;
        bool accepted = false;
        for (int trial = 0; trial < most_trials && !accepted; ++trial) {
            if (trial > 0) move(fraction);
            kept = cut_move();
            evaluate(space_.trial);
            line.objective = space_.trial.objective;
            line.slope = dot(*part_.compute, space_.trial.residual, space_.direction);
            line.objective_known = !space_.springs.rate_damping && !rows_met();
            // While pins or obstacles are on their way, the objective may have to rise.
            accepted = !part_.options.line_search || !was_arrived || accept_trial(fraction * kept, line);
            if (accepted) break;
            fraction *= kept * shorten(line);
            ++report_.line_search_cuts;
        }
        std::swap(space_.current, space_.trial);
        if (accepted && fraction * kept == 1.0 && was_arrived && !small) go_on(line);
        const bool by_change = small && direction_is_good_ && fraction * kept == 1.0 && !part_.settings->newton_tolerance &&
                               report_.newton_iterations > 1;
        converged_ = was_arrived && (by_change || (!accepted && flat));
        return !converged_;
    }

    bool rows_met() const { return space_.current.forces.rows.size() + space_.trial.forces.rows.size() > 0; }

    /// A clamped matrix is too stiff where cloth buckles or begins to slide: the slope then hardly falls over a full step, and
    /// what the secant says is still missing along the same direction costs an evaluation only.
    void go_on(LineTrial line) {
        const double ratio = line.slope / line.start_slope;
        if (!(ratio > slope_left) || !part_.options.line_search || part_.settings->newton_iterations == 1) return;
        const double further = std::min(ratio / std::max(1.0 - ratio, 0.1), 3.0);
        line.start_objective = line.objective;
        line.start_slope = line.slope;
        move(further);
        const double kept = cut_move();
        evaluate(space_.trial);
        line.objective = space_.trial.objective;
        line.slope = dot(*part_.compute, space_.trial.residual, space_.direction);
        if (accept_trial(further * kept, line)) std::swap(space_.current, space_.trial);
        went_on_ = true;
    }

    /// Whether another iteration would change little, by what the preconditioner makes of the residual: far cheaper than the
    /// iteration.
    bool estimate_is_small() {
        if (part_.settings->newton_tolerance || !arrived() || went_on_) return false;
        StageTimer timer(stages_.solve);
        if (!space_.solver.estimate(space_.current.residual, space_.direction)) return false;
        add_scaled(space_.direction, -2.0, space_.direction);  // the direction is -A^-1 r
        return is_small(space_.current.velocities, estimated_share);
    }

    /// Whether the direction, which leads to the velocities `ahead`, changes less than a share of the time error.
    bool is_small(const Vectors& ahead, double share) const {
        const NewtonPoint& point = space_.current;
        return change_is_small(error_, {point.residual, space_.direction, ahead, point.forces.rows.size() > 0}, share);
    }

    void finish(ClothState& state) {
        state.positions = space_.current.positions;
        state.velocities = space_.current.velocities;
        for (int i = 0; i < model_.vertex_count(); ++i) {
            if ((*part_.free)[i] > 0.0 || !arrived()) continue;
            state.positions.set(i, part_.targets->at(i));
        }
        if (part_.settings->adaptive) report_.time_error = time_error(error_, space_.current.velocities);
        if (part_.plan->contacts) set_grips(space_.current.forces.contact.touches, state.grips);
        update_points(state);
        if (projects()) space_.projection.keep(space_.current.forces.rows, space_.current.row_forces);
    }

    const ImplicitPart& part_;
    const ClothModel& model_;
    NewtonSpace& space_;
    StageTimes& stages_;
    NewtonReport report_;
    const Vectors *base_positions_ = nullptr, *base_velocities_ = nullptr;
    TimeError error_;
    double contact_dt_ = part_.dt * std::sqrt(part_.contact_weight);  // s, for which weighted contact has the form of a step's
    bool converged_ = false;
    bool direction_is_good_ = true;  // the linear solve got where it should
    int rounds_ = 0;                 // of multipliers
    bool went_on_ = false;           // the state is not the one whose matrix was solved with
};

}  // namespace

NewtonReport solve_implicit(const ImplicitPart& part, NewtonSpace& space, ClothState& state, StageTimes& stages) {
    return NewtonSolve(part, space, stages).run(state);
}

}  // namespace percale
