#include "explicit_span.h"

#include <cmath>

#include "model/schemes.h"
#include "scripted_motion.h"
#include "step_control.h"
#include "support/stage_timer.h"

namespace percale {
namespace {

/// world.explicit_space.forces at a state.
void evaluate_at(World& world, const ClothState& state) {
    ExplicitSpace& space = world.explicit_space;
    set_step_springs(world.compute, {world.model.adjacency, state.positions, DampingForm::velocity, world.settings.time_step},
                     space.springs);
    const ForceInput input{.compute = &world.compute,
                           .model = &world.model,
                           .springs = &space.springs,
                           .positions = &state.positions,
                           .velocities = &state.velocities,
                           .gravity = world.settings.gravity,
                           .dt = world.settings.time_step,
                           .with_matrix = false};
    evaluate_forces(input, space.forces);
}

void make_step(World& world, StepFraction span) {
    set_part_targets(world, span.to);
    const ExplicitPart part{.compute = &world.compute,
                            .model = &world.model,
                            .settings = &world.settings,
                            .targets = &world.part_targets,
                            .free = &world.script.free,
                            .dt = world.settings.time_step * (span.to - span.from)};
    step_explicit(world.plan.scheme, part, world.explicit_space, world.state);
}

/// A whole step and two half ones: what they differ by over 2^order - 1 is the error of the latter.
void make_two_steps(World& world, StepFraction span) {
    StageSpace& stages = world.stages;
    stages.start.positions = world.state.positions;
    stages.start.velocities = world.state.velocities;
    make_step(world, span);
    stages.scratch = world.state.positions;
    world.state.positions = stages.start.positions;
    world.state.velocities = stages.start.velocities;
    const double middle = 0.5 * (span.from + span.to);
    make_step(world, {span.from, middle});
    make_step(world, {middle, span.to});
    add_scaled(stages.scratch, -1.0, world.state.positions);
    stages.error += mean_size(world, stages.scratch) / (std::pow(2.0, facts_of(world.plan.scheme).order) - 1.0);
}

}  // namespace

void solve_explicit_span(World& world, StepFraction span) {
    StageTimer timer(world.report.stages.force);
    world.settings.adaptive ? make_two_steps(world, span) : make_step(world, span);
    if (world.plan.pin_work) {
        world.report.energy.work += pin_work(world, world.settings.adaptive ? world.stages.start : world.before);
    }
}

void set_accelerations(World& world, const ClothState& state, Vectors& accelerations) {
    StageTimer timer(world.report.stages.force);
    evaluate_at(world, state);
    accelerations.resize(world.model.vertex_count());
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] == 0.0) continue;
        accelerations.set(i, world.explicit_space.forces.total.at(i) / world.model.mass[i]);
    }
}

double pin_work(World& world, const ClothState& start) {
    evaluate_at(world, start);
    world.explicit_space.start_forces = world.explicit_space.forces.total;
    evaluate_at(world, world.state);
    double work = 0.0;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] > 0.0) continue;
        const Vec3 force = 0.5 * (world.explicit_space.start_forces.at(i) + world.explicit_space.forces.total.at(i));
        const double before = start.velocities.at(i).squaredNorm(), after = world.state.velocities.at(i).squaredNorm();
        work += 0.5 * world.model.mass[i] * (after - before) - force.dot(world.state.positions.at(i) - start.positions.at(i));
    }
    return work;
}

}  // namespace percale
