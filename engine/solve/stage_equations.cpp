#include "stage_equations.h"

#include <algorithm>
#include <cmath>

#include "support/stage_timer.h"

namespace percale {
namespace {

/// Scales the forces before and after contact is added, so that the factor of all other forces is 1.
void weigh(const Compute& compute, double factor, Forces& forces) {
    if (factor == 1.0) return;
    Vec3Arrays& total = forces.total;
    set_each(compute, total, total, total, [factor](double force, double) { return force * factor; });
    forces.potential *= factor;
}

/// to = from + fraction (to - from)
void shorten(const Compute& compute, const Vec3Arrays& from, double fraction, Vec3Arrays& to) {
    set_each(compute, from, to, to, [fraction](double a, double b) { return a + fraction * (b - a); });
}

}  // namespace

StageEquations::StageEquations(const ImplicitStage& stage, const ContactWarmStart& warm_start, NewtonSpace& space,
                               StageTimes& times)
    : stage_(stage),
      space_(space),
      times_(times),
      law_(space.law(stage.scene.settings.contact_response)),
      contact_dt_(stage.base.h * std::sqrt(stage.contact_weight)) {
    const StepScene& scene = stage.scene;
    StagePoint& current = space.current;
    copy(scene.compute, stage.start.positions, current.positions);
    copy(scene.compute, stage.start.velocities, current.velocities);
    if (scene.plan.contacts) {
        current.points = stage.start.points;
        space.trial.points.resize(current.points.size());
    }
    current.fraction = stage.moves_are_scripted() ? stage.substep.from : stage.substep.to;
    space.frozen_diagonal.padded = 0;
    if (!space.solver.is_for(scene.model)) space.solver.set_model(scene.compute, scene.model, scene.settings.linear_solver);
    space.solver.matrix.free = scene.script.free;
    space.solver.start_stage();
    if (scene.plan.contacts) law_.begin(warm_start);
    for (auto* vectors : {&space.direction, &space.right_side}) set_zero(scene.compute, *vectors, scene.model.vertex_count());
    space.friction = {.positions = &stage.start.positions,
                      .fraction = stage.substep.from,
                      .stick_anchors = stage.start.stick_anchors,
                      .obstacle_motions = stage.obstacle_motions,
                      .held = &warm_start.held};
    set_step_springs(
        scene.compute,
        {scene.model.adjacency, stage.start.positions, scene.plan.damping, stage.base.h, stage.rest_length, &scene.model.springs},
        space.springs);
}

void StageEquations::predict() {
    const StepScene& scene = stage_.scene;
    StagePoint& current = space_.current;
    const double h = stage_.base.h, rate = 1.0 / h;
    // Velocities along the path are (q - q*)/h: what a clamp takes from the move is not stored as energy.
    set_each(scene.compute, stage_.start.positions, stage_.base.positions, current.velocities,
             [rate](double start, double base) { return rate * start - rate * base; });
    set_each(scene.compute, stage_.start.velocities, current.velocities, space_.direction,
             [](double start, double now) { return start - now; });
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) continue;
        space_.direction.set(i, (stage_.targets.at(i) - stage_.base.positions.at(i)) / h - current.velocities.at(i));
    }
    aim(1.0);
    if (scene.plan.contacts) {
        StageTimer timer(times_.refresh);
        scene.detector->update_candidates(current.points, space_.trial.points);
    }
    cut();
    std::swap(space_.current, space_.trial);
}

void StageEquations::aim(double factor) {
    StagePoint& trial = space_.trial;
    set_each(stage_.scene.compute, space_.current.velocities, space_.direction, trial.velocities,
             [factor](double v, double dv) { return v + factor * dv; });
    place(trial);
    const double reached = space_.current.fraction;
    trial.fraction = factor == 1.0 ? stage_.substep.to : reached + factor * (stage_.substep.to - reached);
}

void StageEquations::place(StagePoint& point) const {
    const Compute& compute = stage_.scene.compute;
    const double h = stage_.base.h;
    set_each(compute, stage_.base.positions, point.velocities, point.positions, [h](double q, double v) { return q + h * v; });
    if (stage_.scene.plan.contacts) copy_out(compute, point.positions, point.points);
}

double StageEquations::cut() {
    if (!stage_.scene.plan.contacts) return 1.0;
    StageTimer timer(times_.cut);
    const StagePoint& current = space_.current;
    StagePoint& trial = space_.trial;
    const StepFraction substep{current.fraction, trial.fraction};
    const double kept = stage_.scene.detector->collision_free_step_size(current.points, trial.points, substep);
    smallest_fraction_ = std::min(smallest_fraction_, kept);
    if (kept >= 1.0) return 1.0;
    shorten(stage_.scene.compute, current.velocities, kept, trial.velocities);
    place(trial);
    if (stage_.moves_are_scripted()) trial.fraction = current.fraction + kept * (substep.to - substep.from);
    return kept;
}

void StageEquations::evaluate(StagePoint& point) {
    const StepScene& scene = stage_.scene;
    if (scene.plan.contacts) {
        StageTimer timer(times_.evaluate);
        scene.detector->find_contacts(point.points, point.fraction, point.constraints);
    }
    StageTimer timer(times_.force);
    evaluate_forces({.compute = &scene.compute,
                     .model = &scene.model,
                     .springs = &space_.springs,
                     .positions = &point.positions,
                     .velocities = &point.velocities,
                     .gravity = scene.settings.gravity,
                     .wind = stage_.wind,
                     .dt = stage_.base.h,
                     .with_matrix = true},
                    point.forces);
    if (scene.plan.contacts) {
        add_contact(point);
    } else {  // terms of a scene that had contact before
        point.constraints.clear();
        point.constraint_forces.clear();
        point.contact.clear();
    }
    set_residual(point);
}

void StageEquations::add_contact(StagePoint& point) {
    const bool first = space_.frozen_diagonal.padded == 0;
    if (first) {
        fill_diagonal(space_.solver.matrix, point.forces.spring_terms, space_.frozen_diagonal, space_.frozen_inverse);
        space_.frozen_load = point.forces.total;
        law_.set_constraints(point.constraints);
    }
    weigh(stage_.scene.compute, 1.0 / stage_.contact_weight, point.forces);
    law_.evaluate(contact_point(point, first), contact_forces(point));
    weigh(stage_.scene.compute, stage_.contact_weight, point.forces);
    largest_stiffness_ = std::max(largest_stiffness_, point.contact.largest_stiffness);
}

ContactPoint StageEquations::contact_point(const StagePoint& point, bool first) const {
    const StepScene& scene = stage_.scene;
    return {.constraints = point.constraints,
            .positions = point.positions,
            .velocities = point.velocities,
            .step = {.dt = contact_dt_,
                     .stiffness_dt = stage_.contact_dt,
                     .obstacle_rate = 1.0 / scene.settings.time_step,
                     .fraction = point.fraction,
                     .gravity = scene.settings.gravity,
                     .mass = &scene.model.mass,
                     .diagonal = &space_.frozen_diagonal,
                     .load = &space_.frozen_load,
                     .friction = &space_.friction,
                     .previous = first ? nullptr : &space_.current.contact.friction_contacts},
            .obstacles_moved = point.fraction - stage_.substep.from};
}

ContactForces StageEquations::contact_forces(StagePoint& point) {
    return {point.forces.total, point.forces.potential, point.contact, point.constraint_forces};
}

bool StageEquations::correct_contact(double enough) {
    StagePoint& point = space_.current;
    if (!stage_.scene.plan.contacts || point.constraints.size() == 0) return false;
    StageTimer timer(times_.force);
    if (!law_.correct(contact_point(point, false), contact_forces(point), enough)) return false;
    set_residual(point);
    return true;
}

void StageEquations::end_contact(ContactWarmStart& warm_start) const {
    if (stage_.scene.plan.contacts)
        law_.end(space_.current.constraints, space_.current.contact, space_.current.constraint_forces, warm_start);
}

void StageEquations::set_residual(StagePoint& point) const {
    const StepScene& scene = stage_.scene;
    if (point.residual.padded_size() != point.velocities.padded_size()) point.residual.resize(scene.model.vertex_count());
    const Vec3Arrays &force = point.forces.total, &velocity = point.velocities, &start = stage_.base.velocities;
    const double *free = scene.script.free.data(), *mass = scene.model.mass.data();
    const int count = scene.model.vertex_count();
    const double dt = stage_.base.h;
    const auto set_axis = [=](const double* f, const double* v, const double* v_start, double* r, int first, int last) {
        for (int i = first; i < last; ++i) r[i] = free[i] * (mass[i] * (v[i] - v_start[i]) - dt * f[i]);
    };
    const double distance = sum_chunks(scene.compute, velocity.slices(), [&](Slices range) {
        const int first = range.first * slice_lanes, last = std::min(range.last * slice_lanes, count);
        set_axis(force.x.data(), velocity.x.data(), start.x.data(), point.residual.x.data(), first, last);
        set_axis(force.y.data(), velocity.y.data(), start.y.data(), point.residual.y.data(), first, last);
        set_axis(force.z.data(), velocity.z.data(), start.z.data(), point.residual.z.data(), first, last);
        return sum_terms(first, last - first, [&](int i) { return free[i] * mass[i] * square_between(velocity, start, i); });
    });
    point.objective = 0.5 * distance + point.forces.potential;
}

}  // namespace percale
