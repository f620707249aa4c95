#include "explicit_span.h"

#include <cmath>

#include "schemes/schemes.h"
#include "scripted_motion.h"
#include "span_ledger.h"
#include "step_control.h"
#include "support/stage_timer.h"

namespace percale {
namespace {

void evaluate_state(World& world, const ClothState& state) {
    evaluate_at(world, {state.positions, state.velocities, state.positions});
}

void make_step(World& world, StepFraction span) {
    set_part_targets(world, span.to);
    world.part = span;
    set_seams_at(world, 0.5);
    const ExplicitPart part{.compute = &world.compute,
                            .model = &world.model,
                            .settings = &world.settings,
                            .targets = &world.part_targets,
                            .free = &world.script.free,
                            .dt = world.settings.time_step * (span.to - span.from),
                            .wind = set_wind_at(world, world.state.positions)};
    step_explicit(world.plan.scheme, part, world.explicit_space, world.state);
}

/// A step that counts.
void make_kept_step(World& world, StepFraction span) {
    if (!world.plan.ledger && !world.plan.seams_close) return make_step(world, span);
    ClothState& start = world.ledger.start;
    start.positions = world.state.positions;
    start.velocities = world.state.velocities;
    make_step(world, span);
    if (world.plan.ledger) {
        account_explicit(world, {start.positions, start.velocities, world.settings.time_step * (span.to - span.from)});
    }
    world.seam_work += seam_work(world, start.positions);
}

/// A whole step and two half ones: what they differ by over 2^order - 1 is the error of the latter.
void make_two_steps(World& world, StepFraction span) {
    StageSpace& stages = world.stages;
    make_step(world, span);
    stages.scratch = world.state.positions;
    world.state.positions = stages.start.positions;
    world.state.velocities = stages.start.velocities;
    const double middle = 0.5 * (span.from + span.to);
    make_kept_step(world, {span.from, middle});
    make_kept_step(world, {middle, span.to});
    add_scaled(stages.scratch, -1.0, world.state.positions);
    stages.error += mean_size(world, stages.scratch) / (std::pow(2.0, facts_of(world.plan.scheme).order) - 1.0);
}

}  // namespace

void solve_explicit_span(World& world, StepFraction span) {
    StageTimer timer(world.report.stages.force);
    ClothState& start = world.stages.start;
    start.positions = world.state.positions;
    start.velocities = world.state.velocities;
    world.seam_work = 0.0;
    world.settings.adaptive ? make_two_steps(world, span) : make_kept_step(world, span);
    const auto [pins, wind] = script_work(world, start, world.settings.time_step * (span.to - span.from));
    world.report.energy.work += world.seam_work + pins + wind;
    if (world.plan.ledger) world.report.energy.dissipated_integrator += pins + wind;  // account_explicit
}

void evaluate_at(World& world, const ForcePlace& place) {
    ExplicitSpace& space = world.explicit_space;
    set_step_springs(world.compute, {world.model.adjacency, place.positions, DampingForm::velocity, world.settings.time_step},
                     space.springs);
    const ForceInput input{.compute = &world.compute,
                           .model = &world.model,
                           .springs = &space.springs,
                           .positions = &place.positions,
                           .velocities = &place.velocities,
                           .gravity = world.settings.gravity,
                           .wind = set_wind_at(world, place.air),
                           .dt = world.settings.time_step,
                           .with_matrix = false};
    evaluate_forces(input, space.forces);
}

void set_accelerations(World& world, const ClothState& state, Vectors& accelerations) {
    StageTimer timer(world.report.stages.force);
    evaluate_state(world, state);
    accelerations.resize(world.model.vertex_count());
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] == 0.0) continue;
        accelerations.set(i, world.explicit_space.forces.total.at(i) / world.model.mass[i]);
    }
}

ScriptWork script_work(World& world, const ClothState& start, double length) {
    if (!world.plan.pin_work && !(world.plan.wind && world.plan.measures)) return {};
    evaluate_state(world, start);
    world.explicit_space.start_forces = world.explicit_space.forces.total;
    double power = world.explicit_space.forces.wind.power;
    evaluate_state(world, world.state);
    power += world.explicit_space.forces.wind.power;
    ScriptWork work{.wind = 0.5 * length * power};
    if (!world.plan.pin_work) return work;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] > 0.0) continue;
        const Vec3 force = 0.5 * (world.explicit_space.start_forces.at(i) + world.explicit_space.forces.total.at(i));
        const double before = start.velocities.at(i).squaredNorm(), after = world.state.velocities.at(i).squaredNorm();
        work.pins +=
            0.5 * world.model.mass[i] * (after - before) - force.dot(world.state.positions.at(i) - start.positions.at(i));
    }
    return work;
}

}  // namespace percale
