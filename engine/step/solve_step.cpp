#include "solve_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "explicit_span.h"
#include "implicit_stages.h"
#include "ledger.h"
#include "schemes/schemes.h"

namespace percale {
namespace {

constexpr int most_halvings = 6;  // of one step, one inside the other
/// s per second: how fast the time step that contact stiffness is made for may become shorter. Stiffness goes as 1/dt^2, and what
/// a stiffer contact stores nobody has paid for; slowly against its own period, 2 pi sqrt(2) dt, it stores nothing.
constexpr double fastest_shortening = 0.05;

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

bool may_halve(int depth) { return depth < most_halvings; }

/// Solves a span of the step; false after a failure that halving could not mend.
bool solve_span(World& world, StepFraction span, int depth) {
    const bool halve = may_halve(depth);
    const NewtonEnd end = solve_implicit_span(world, span, !halve);
    if (end == NewtonEnd::converged || (end == NewtonEnd::iterations_used && !halve)) {
        const double length = world.settings.time_step * (span.to - span.from);
        world.report.smallest_dt = std::min(world.report.smallest_dt, length);
        world.report.largest_dt = std::max(world.report.largest_dt, length);
        const double work = span_work(world, span);
        world.report.energy.work += work;
        if (world.plan.ledger) account_implicit(world, length, work - world.seam_work);
        if (end != NewtonEnd::converged) world.report.status = StepStatus::not_converged;
        return true;
    }
    if (halve) {
        ++world.report.halvings;
        restore_span_start(world);
        const double middle = 0.5 * (span.from + span.to);
        return solve_span(world, {span.from, middle}, depth + 1) && solve_span(world, {middle, span.to}, depth + 1);
    }
    fail(world, end);
    return false;
}

/// One step of the scheme over a span; false if it failed.
bool cover(World& world, StepFraction span) {
    if (world.plan.implicit) return solve_span(world, span, 0);
    const double length = (span.to - span.from) / world.plan.parts;
    for (int part = 0; part < world.plan.parts; ++part) {
        const bool last = part + 1 == world.plan.parts;
        solve_explicit_span(world, {span.from + part * length, last ? span.to : span.from + (part + 1) * length});
    }
    world.report.smallest_dt = std::min(world.report.smallest_dt, length * world.settings.time_step);
    return true;
}

void save_attempt(World& world) {
    ClothState& attempt = world.stages.attempt;
    attempt.positions = world.state.positions;
    attempt.velocities = world.state.velocities;
    attempt.grips = world.state.grips;
    world.stages.attempt_unbalanced = world.stages.unbalanced;
    world.stages.error = 0.0;
}

void take_back(World& world, StepStatus status, const StepEnergy& energy) {
    const ClothState& attempt = world.stages.attempt;
    world.state.positions = attempt.positions;
    world.state.velocities = attempt.velocities;
    world.state.grips = attempt.grips;
    update_points(world.state);
    world.stages.forget();
    world.stages.unbalanced = world.stages.attempt_unbalanced;
    world.report.status = status;
    world.report.energy = energy;
    ++world.report.rejected;
}

/// Covers the step by as many spans as the tolerance asks for.
bool cover_adaptively(World& world) {
    const double whole = world.settings.time_step;
    StepReport& report = world.report;
    double shortest = whole, longest = 0.0;
    report.parts = 0;
    for (double at = 0.0; at < 1.0;) {
        save_attempt(world);
        const StepStatus status = report.status;
        const StepEnergy energy = report.energy;
        const double contact = world.ledger.contact;
        const double length = next_length(world.stages.control, whole * (1.0 - at));
        const double share = length / whole, to = at + share > 1.0 - 1e-9 ? 1.0 : at + share;
        if (!cover(world, {at, to})) return false;
        const bool touching = world.plan.contacts && world.newton.current.forces.rows.size() > 0;
        const StepAttempt attempt{length, world.stages.error, facts_of(world.plan.scheme).order, touching};
        if (!accept_attempt(attempt, world.settings.tolerance, world.stages.control)) {
            take_back(world, status, energy);
            world.ledger.contact = contact;
            continue;
        }
        if (world.stages.control.missed && report.status == StepStatus::ok) report.status = StepStatus::tolerance_missed;
        ++report.parts;
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
        at = to;
    }
    report.smallest_dt = shortest;
    report.largest_dt = longest;
    return true;
}

}  // namespace

void solve_step(World& world) {
    if (!world.plan.solve) return world.state.velocities.resize(world.model.vertex_count());
    if (world.plan.ledger) begin_ledger(world);
    if (world.plan.implicit && !world.plan.keep_work_space) {
        const LinearSolver solver = world.newton.solver.in_use();
        ContactProjection projection = std::move(world.newton.projection);
        world.newton = NewtonSpace{};
        world.newton.projection = std::move(projection);
        world.newton.solver.begin_with(solver);
    }
    world.contact_dt = std::max(world.settings.time_step, world.contact_dt - fastest_shortening * world.settings.time_step);
    const bool good = world.settings.adaptive ? cover_adaptively(world) : cover(world, {0.0, 1.0});
    if (!good) world.stages.forget();
    if (good && world.report.halvings > 0 && world.report.status == StepStatus::ok) world.report.status = StepStatus::halved;
}

}  // namespace percale
