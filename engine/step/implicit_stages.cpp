#include "implicit_stages.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>

#include "explicit_span.h"
#include "schemes/schemes.h"
#include "scripted_motion.h"
#include "span_ledger.h"
#include "step_control.h"

namespace percale {
namespace {

/// One nonlinear system.
struct Stage {
    StepFraction span;
    const StageBase* base = nullptr;  // null: backward Euler
    double contact_weight = 1.0;
};

void add_figures(const NewtonReport& part, StepReport& report) {
    report.newton_iterations += part.newton_iterations;
    report.linear_iterations += part.linear_iterations;
    report.line_search_cuts += part.line_search_cuts;
    report.residual = part.residual;
    report.smallest_fraction = std::min(report.smallest_fraction, part.smallest_fraction);
    report.contact_stiffness = std::max(report.contact_stiffness, part.largest_stiffness);
}

void set_flows(World& world, double fraction) {
    world.flows.clear();
    if (!world.plan.obstacles_move) return;
    for (const ObstacleState& obstacle : world.script.obstacles) {
        world.flows.push_back(obstacle_flow(obstacle.start, obstacle.end, fraction));
    }
}

NewtonReport solve_stage(World& world, const Stage& stage) {
    const StepFraction span = stage.span;
    const double length = world.settings.time_step * (span.to - span.from);
    set_flows(world, span.from);
    const ImplicitPart part{.compute = &world.compute,
                            .model = &world.model,
                            .settings = &world.settings,
                            .plan = &world.plan,
                            .detector = world.detector.get(),
                            .targets = &world.part_targets,
                            .free = &world.script.free,
                            .dt = stage.base ? stage.base->h : length,
                            .base = stage.base,
                            .contact_weight = stage.contact_weight,
                            .full_step = world.settings.time_step,
                            .contact_dt = world.contact_dt,
                            .span = span,
                            .flows = world.flows,
                            .wind = set_wind_at(world, world.state.positions),
                            .options = {}};
    const NewtonReport report = solve_implicit(part, world.newton, world.state, world.report.stages);
    add_figures(report, world.report);
    world.report.linear_solver = world.newton.solver.in_use();
    return report;
}

/// A stage from world.stages.base, its prescribed vertices at a steady speed.
NewtonReport solve_from_base(World& world, StepFraction span, double contact_weight) {
    set_part_targets(world, span.to);
    const double length = world.settings.time_step * (span.to - span.from);
    set_prescribed_base(world.script.free, world.state.positions, world.part_targets, length, world.stages.base);
    return solve_stage(world, {span, &world.stages.base, contact_weight});
}

bool usable(NewtonEnd end, bool go_on) { return end == NewtonEnd::converged || (go_on && end == NewtonEnd::iterations_used); }

void save_start(World& world) {
    StageSpace& stages = world.stages;
    stages.start.positions = world.state.positions;
    stages.start.velocities = world.state.velocities;
    stages.start.grips = world.state.grips;
}

/// world.stages.acceleration = (v - v*)/h, that of the stage's end.
void set_end_acceleration(World& world) {
    StageSpace& stages = world.stages;
    stages.acceleration.resize(world.model.vertex_count());
    set_extrapolated(stages.acceleration, 1.0 / stages.base.h, world.state.velocities, stages.base.velocities,
                     stages.acceleration);
}

void set_start_accelerations(World& world) {
    set_seams_at(world, 0.0);
    set_accelerations(world, world.stages.start, world.stages.acceleration);
}

/// The old acceleration of the trapezoid, M a = f + what the last solve left unbalanced. Without that, stiff springs would answer
/// an error e of the solver's positions by (w h)^2 e, and again in each step.
void set_old_accelerations(World& world) {
    StageSpace& stages = world.stages;
    set_start_accelerations(world);
    if (stages.unbalanced.padded_size() == 0) return;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] > 0.0) stages.acceleration.add(i, stages.unbalanced.at(i) / world.model.mass[i]);
    }
}

/// world.stages.unbalanced of the state that the last stage led to.
void keep_unbalanced(World& world) {
    StageSpace& stages = world.stages;
    stages.unbalanced.resize(world.model.vertex_count());
    add_scaled(stages.unbalanced, 1.0 / stages.base.h, world.newton.current.residual);
}

NewtonReport solve_backward_euler(World& world, StepFraction span) {
    set_part_targets(world, span.to);
    set_seams_at(world, 1.0);
    const NewtonReport report = solve_stage(world, {.span = span});
    world.stages.error += report.time_error;
    return report;
}

NewtonReport solve_midpoint(World& world, StepFraction span) {
    StageSpace& stages = world.stages;
    const double length = world.settings.time_step * (span.to - span.from);
    set_start_accelerations(world);
    set_midpoint_base(stages.start, stages.acceleration, length, stages.base);
    set_seams_at(world, 0.5);
    const NewtonReport report = solve_from_base(world, {span.from, 0.5 * (span.from + span.to)}, 1.0);
    if (report.end == NewtonEnd::not_finite || report.end == NewtonEnd::blocked) return report;
    stages.error += 2.0 * report.time_error;
    ClothState& state = world.state;
    set_extrapolated(state.positions, 1.0, state.positions, stages.start.positions, state.positions);
    set_extrapolated(state.velocities, 1.0, state.velocities, stages.start.velocities, state.velocities);
    set_part_targets(world, span.to);
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] > 0.0) continue;
        state.positions.set(i, world.part_targets.at(i));
        state.velocities.set(i, (world.part_targets.at(i) - stages.start.positions.at(i)) / length);
    }
    update_points(state);
    return report;
}

NewtonReport solve_trapezoid(World& world, StepFraction span, bool go_on) {
    StageSpace& stages = world.stages;
    set_old_accelerations(world);
    set_trapezoid_base(stages.start, stages.acceleration, world.settings.time_step * (span.to - span.from), stages.base);
    set_seams_at(world, 1.0);
    const NewtonReport report = solve_from_base(world, span, 1.0);
    stages.error += report.time_error;
    if (usable(report.end, go_on)) keep_unbalanced(world);
    return report;
}

/// The nearest row first. A row changes what the next ones see, and the order in which they were found depends on the axes.
std::span<const std::size_t> in_order_of_distance(const ContactRows& rows, std::vector<std::size_t>& order) {
    order.resize(rows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(rows.distance[a], rows.vertex[a], rows.feature[a]) <
               std::tie(rows.distance[b], rows.vertex[b], rows.feature[b]);
    });
    return order;
}

/// What contact gives a cloth in a stage of the trapezoid is twice what stops it there. A point that is pressed leaves no faster
/// than it went in the mean of the stage, and not at all if it came nearer.
void settle_impacts(World& world, const Vectors& start, double length) {
    const ContactRows& rows = world.newton.current.forces.rows;
    for (const std::size_t row : in_order_of_distance(rows, world.stages.row_order)) {
        if (rows.distance[row] >= rows.thickness[row]) continue;
        Vec3 velocity = -rows.obstacle_displacement[row] / world.settings.time_step, mean = velocity;
        double mobility = 0.0;
        for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
            const int vertex = rows.vertex[row][k];
            const double weight = rows.weight[row][k];
            velocity += weight * world.state.velocities.at(vertex);
            mean += weight / length * (world.state.positions.at(vertex) - start.at(vertex));
            mobility += world.script.free[vertex] * weight * weight / world.model.mass[vertex];
        }
        const Vec3& n = rows.direction[row];
        const double excess = n.dot(velocity) - std::max(n.dot(mean), 0.0);
        if (excess <= 0.0 || mobility == 0.0) continue;
        for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
            const int vertex = rows.vertex[row][k];
            const double share = world.script.free[vertex] * rows.weight[row][k] / (world.model.mass[vertex] * mobility);
            world.state.velocities.add(vertex, -rows.share[row] * share * excess * n);
        }
    }
}

/// Against the companion of third order with the weights (1 - w)/3, w + 1/3, g/6 instead of w, w, g/2, w = sqrt 2/4.
double companion_error(World& world, double length) {
    constexpr double w = std::numbers::sqrt2 / 4.0;
    Vectors& error = world.stages.scratch;
    error.resize(world.model.vertex_count());
    add_scaled(error, length * (4.0 * w - 1.0) / 3.0, world.stages.start.velocities);
    add_scaled(error, -length / 3.0, world.newton.start_velocities);
    add_scaled(error, length * trapezoid_share / 3.0, world.state.velocities);
    return mean_size(world, error);
}

NewtonReport solve_tr_bdf2(World& world, StepFraction span, bool go_on) {
    StageSpace& stages = world.stages;
    const double length = world.settings.time_step * (span.to - span.from), first = trapezoid_share * length;
    const double middle = span.from + trapezoid_share * (span.to - span.from);
    set_old_accelerations(world);
    set_trapezoid_base(stages.start, stages.acceleration, first, stages.base);
    set_seams_at(world, trapezoid_share);
    const NewtonReport trapezoid = solve_from_base(world, {span.from, middle}, 2.0);
    if (!usable(trapezoid.end, go_on)) return trapezoid;
    if (world.plan.contacts) settle_impacts(world, stages.start.positions, first);
    stages.obstacle_work = (length - stages.base.h) * world.newton.current.forces.contact.obstacle_power;
    set_end_acceleration(world);
    set_bdf2_base(world.state, stages.acceleration, stages.start, length - first, first, stages.base);
    set_seams_at(world, 1.0);
    NewtonReport report = solve_from_base(world, {middle, span.to}, 1.0);
    if (trapezoid.end != NewtonEnd::converged && report.end == NewtonEnd::converged) report.end = trapezoid.end;
    if (!usable(report.end, go_on)) return report;
    if (world.settings.adaptive) stages.error += companion_error(world, length);
    if (world.plan.contacts) settle_impacts(world, world.newton.start_positions, length - first);
    stages.obstacle_work += stages.base.h * world.newton.current.forces.contact.obstacle_power;
    set_end_acceleration(world);
    keep_unbalanced(world);
    return report;
}

/// Begins with a step of TR-BDF2, which is of second order and needs no earlier state.
NewtonReport solve_bdf2(World& world, StepFraction span, bool go_on) {
    StageSpace& stages = world.stages;
    const double length = world.settings.time_step * (span.to - span.from);
    NewtonReport report;
    if (stages.earlier_length == 0.0) {
        report = solve_tr_bdf2(world, span, go_on);
    } else {
        set_bdf2_base(stages.start, stages.acceleration, stages.earlier, length, stages.earlier_length, stages.base);
        set_seams_at(world, 1.0);
        report = solve_from_base(world, span, 1.0);
        stages.error += report.time_error;
    }
    if (!usable(report.end, go_on)) return report;
    set_end_acceleration(world);
    stages.earlier.positions = stages.start.positions;
    stages.earlier.velocities = stages.start.velocities;
    stages.earlier_length = length;
    return report;
}

NewtonReport solve_by_scheme(World& world, StepFraction span, bool go_on) {
    switch (world.plan.scheme) {
        case Scheme::implicit_midpoint:
            return solve_midpoint(world, span);
        case Scheme::trapezoid:
            return solve_trapezoid(world, span, go_on);
        case Scheme::bdf2:
            return solve_bdf2(world, span, go_on);
        case Scheme::tr_bdf2:
            return solve_tr_bdf2(world, span, go_on);
        default:
            return solve_backward_euler(world, span);
    }
}

/// Work of pins, obstacles and wind in a part of backward Euler, J: a pin's reaction is what its residual lacks, M (v - v_n) -
/// dt f.
double backward_euler_work(World& world, double dt) {
    const NewtonPoint& end = world.newton.current;
    double work = world.plan.contacts ? dt * end.forces.contact.obstacle_power : 0.0;
    work += dt * end.forces.wind.power;
    if (!world.plan.pin_work) return work;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] > 0.0) continue;
        const Vec3 change = end.velocities.at(i) - world.newton.start_velocities.at(i);
        const Vec3 impulse = world.model.mass[i] * change - dt * end.forces.total.at(i);
        work += impulse.dot(end.velocities.at(i));
    }
    return work;
}

}  // namespace

NewtonEnd solve_implicit_span(World& world, StepFraction span, bool go_on) {
    if (world.plan.scheme != Scheme::backward_euler) save_start(world);
    world.part = span;
    world.stages.obstacle_work = 0.0;
    return solve_by_scheme(world, span, go_on).end;
}

void restore_span_start(World& world) {
    const bool euler = world.plan.scheme == Scheme::backward_euler;
    world.state.positions = euler ? world.newton.start_positions : world.stages.start.positions;
    world.state.velocities = euler ? world.newton.start_velocities : world.stages.start.velocities;
    world.state.grips = euler ? world.newton.start_grips : world.stages.start.grips;
    update_points(world.state);
}

double span_work(World& world, StepFraction span) {
    const double length = world.settings.time_step * (span.to - span.from);
    const bool euler = world.plan.scheme == Scheme::backward_euler;
    world.seam_work = seam_work(world, euler ? world.newton.start_positions : world.stages.start.positions);
    if (euler) return world.seam_work + backward_euler_work(world, length);
    const ClothState& start = world.stages.start;
    const double wind = stage_wind_work(world, {start.positions, start.velocities, length});
    return world.seam_work + world.stages.obstacle_work + wind + script_work(world, start, length).pins;
}

}  // namespace percale
