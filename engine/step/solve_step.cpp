#include "solve_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scripted_motion.h"
#include "support/stage_timer.h"

namespace percale {
namespace {

constexpr int most_halvings = 6;  // of one step, one inside the other
/// s per second: how fast the time step that contact stiffness is made for may become shorter. Stiffness goes as 1/dt^2, and what
/// a stiffer contact stores nobody has paid for; slowly against its own period, 2 pi sqrt(2) dt, it stores nothing.
constexpr double fastest_shortening = 0.05;

/// space.forces at a state of an explicit scheme.
void evaluate_at(World& world, const ClothState& state) {
    ExplicitSpace& space = world.explicit_space;
    const ForceInput input{.compute = &world.compute,
                           .model = &world.model,
                           .springs = &space.springs,
                           .positions = &state.positions,
                           .velocities = &state.velocities,
                           .gravity = world.settings.gravity,
                           .wind = set_wind_at(world, state.positions),
                           .dt = world.settings.time_step,
                           .with_matrix = false};
    evaluate_forces(input, space.forces);
}

/// Work of moving pins and of the wind in an explicit step, J: what the pins' kinetic energy gained less the work of the mean of
/// the forces at both ends; the wind's mean power.
double explicit_work(World& world) {
    evaluate_at(world, world.before);
    world.explicit_space.start_forces = world.explicit_space.forces.total;
    double power = world.explicit_space.forces.wind.power;
    evaluate_at(world, world.state);
    power += world.explicit_space.forces.wind.power;
    double work = 0.5 * world.settings.time_step * power;
    if (!world.plan.pin_work) return work;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] > 0.0) continue;
        const Vec3 force = 0.5 * (world.explicit_space.start_forces.at(i) + world.explicit_space.forces.total.at(i));
        const double before = world.before.velocities.at(i).squaredNorm(), after = world.state.velocities.at(i).squaredNorm();
        work +=
            0.5 * world.model.mass[i] * (after - before) - force.dot(world.state.positions.at(i) - world.before.positions.at(i));
    }
    return work;
}

void solve_explicit(World& world) {
    StageTimer timer(world.report.stages.force);
    set_part_targets(world, 1.0);
    set_part_seams(world, {0.0, 1.0});
    const ExplicitPart part{.compute = &world.compute,
                            .model = &world.model,
                            .settings = &world.settings,
                            .targets = &world.part_targets,
                            .free = &world.script.free,
                            .dt = world.settings.time_step,
                            .wind = set_wind_at(world, world.state.positions)};
    if (world.settings.scheme == Scheme::rk4) {
        step_rk4(part, world.explicit_space, world.state);
    } else {
        step_symplectic_euler(part, world.explicit_space, world.state);
    }
    world.report.energy.work += world.seam_work;
    if (world.plan.pin_work || (world.plan.wind && world.plan.measures)) world.report.energy.work += explicit_work(world);
}

/// Work of pins, obstacles, wind and closing seams during the part just solved, J: a pin's reaction is what its residual lacks, M
/// (v - v_n) - dt f.
double script_work(const World& world, double dt) {
    const NewtonPoint& end = world.newton.current;
    double work = world.plan.contacts ? dt * end.forces.contact.obstacle_power : 0.0;
    work += world.seam_work + dt * end.forces.wind.power;
    if (!world.plan.pin_work) return work;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] > 0.0) continue;
        const Vec3 change = end.velocities.at(i) - world.newton.start_velocities.at(i);
        const Vec3 impulse = world.model.mass[i] * change - dt * end.forces.total.at(i);
        work += impulse.dot(end.velocities.at(i));
    }
    return work;
}

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

NewtonReport solve_part(World& world, StepFraction span) {
    const double dt = world.settings.time_step * (span.to - span.from);
    set_part_targets(world, span.to);
    set_part_seams(world, span);
    set_flows(world, span.from);
    const ImplicitPart part{.compute = &world.compute,
                            .model = &world.model,
                            .settings = &world.settings,
                            .plan = &world.plan,
                            .detector = world.detector.get(),
                            .targets = &world.part_targets,
                            .free = &world.script.free,
                            .dt = dt,
                            .full_step = world.settings.time_step,
                            .contact_dt = world.contact_dt,
                            .span = span,
                            .flows = world.flows,
                            .wind = set_wind_at(world, world.state.positions),
                            .options = {}};
    const NewtonReport part_report = solve_implicit(part, world.newton, world.state, world.report.stages);
    add_figures(part_report, world.report);
    world.report.linear_solver = world.newton.solver.in_use();
    world.report.smallest_dt = std::min(world.report.smallest_dt, dt);
    return part_report;
}

/// Names the pin that is farthest from where it should be.
void name_blocked_pin(World& world) {
    double farthest = 0.0;
    for (std::size_t c = 0; c < world.model.cloths.size(); ++c) {
        const ClothRange& cloth = world.model.cloths[c];
        for (int vertex = 0; vertex < cloth.count; ++vertex) {
            const int i = cloth.index_of(vertex);
            if (world.script.free[i] > 0.0) continue;
            const double missing = (world.newton.current.positions.at(i) - world.part_targets.at(i)).norm();
            if (missing <= farthest) continue;
            farthest = missing;
            world.report.blocked_cloth = static_cast<int>(c);
            world.report.blocked_vertex = vertex;
            world.report.blocked_name = cloth.name;
        }
    }
}

/// Of the contacts with other obstacles that push against the closest one's direction, the closest.
void name_second_obstacle(World& world, std::size_t closest) {
    const ContactRows& rows = world.newton.current.forces.rows;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const bool other = rows.obstacle[row] >= 0 && rows.obstacle[row] != rows.obstacle[closest];
        if (!other || rows.direction[row].dot(rows.direction[closest]) >= 0.0 || rows.distance[row] >= least) continue;
        least = rows.distance[row];
        world.report.second_obstacle = rows.obstacle[row];
    }
    if (world.report.second_obstacle < 0) return;
    world.report.second_name = world.script.obstacles[world.report.second_obstacle].name;
}

/// What the closest contact is with.
void name_blocking_obstacle(World& world) {
    const ContactRows& rows = world.newton.current.forces.rows;
    if (rows.size() == 0) return;
    const auto closest = std::min_element(rows.distance.begin(), rows.distance.end());
    world.report.blocking_obstacle = rows.obstacle[static_cast<std::size_t>(closest - rows.distance.begin())];
    const bool cloth = world.report.blocking_obstacle < 0;
    world.report.blocking_name = cloth ? "cloth" : world.script.obstacles[world.report.blocking_obstacle].name;
    name_second_obstacle(world, static_cast<std::size_t>(closest - rows.distance.begin()));
}

void fail(World& world, NewtonEnd end) {
    if (end == NewtonEnd::not_finite) {
        world.report.status = StepStatus::not_finite;
        return;
    }
    name_blocking_obstacle(world);
    const bool by_obstacle = world.plan.obstacles_move;
    if (world.plan.pins_move) name_blocked_pin(world);
    world.report.status = by_obstacle ? StepStatus::obstacle_too_fast : StepStatus::pin_blocked;
}

bool may_halve(const World& world, int depth) { return depth < most_halvings && world.settings.newton_iterations > 1; }

/// Solves a span of the step; false after a failure that halving could not mend.
bool solve_span(World& world, StepFraction span, int depth) {
    const NewtonReport part = solve_part(world, span);
    if (part.end == NewtonEnd::converged) {
        world.report.energy.work += script_work(world, world.settings.time_step * (span.to - span.from));
        return true;
    }
    if (may_halve(world, depth)) {
        ++world.report.halvings;
        world.state.positions = world.newton.start_positions;
        world.state.velocities = world.newton.start_velocities;
        world.state.grips = world.newton.start_grips;
        update_points(world.state);
        const double middle = 0.5 * (span.from + span.to);
        return solve_span(world, {span.from, middle}, depth + 1) && solve_span(world, {middle, span.to}, depth + 1);
    }
    if (part.end == NewtonEnd::iterations_used) {
        world.report.status = StepStatus::not_converged;
        world.report.energy.work += script_work(world, world.settings.time_step * (span.to - span.from));
        return true;
    }
    fail(world, part.end);
    return false;
}

}  // namespace

void solve_step(World& world) {
    if (!world.plan.solve) return world.state.velocities.resize(world.model.vertex_count());
    if (!world.plan.implicit) return solve_explicit(world);
    if (!world.plan.keep_work_space) {
        const LinearSolver solver = world.newton.solver.in_use();
        ContactProjection projection = std::move(world.newton.projection);
        world.newton = NewtonSpace{};
        world.newton.projection = std::move(projection);
        world.newton.solver.begin_with(solver);
    }
    world.contact_dt = std::max(world.settings.time_step, world.contact_dt - fastest_shortening * world.settings.time_step);
    const bool good = solve_span(world, {0.0, 1.0}, 0);
    if (!good) set_part_seams(world, {0.0, 0.0});
    if (good && world.report.halvings > 0 && world.report.status == StepStatus::ok) world.report.status = StepStatus::halved;
}

}  // namespace percale
