#include "stage_equations.h"

#include <algorithm>
#include <cmath>

#include "contact/contact_secants.h"
#include "contact/contact_stiffness.h"
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

StageEquations::StageEquations(const ImplicitStage& stage, const ContactWarmStart& warm_start, StageSpace& space,
                               const BlockMatrix& matrix, StageTimes& times)
    : stage_(stage),
      space_(space),
      matrix_(matrix),
      times_(times),
      law_(space.law(stage.scene.settings.contact_response)),
      contact_dt_(stage.base.h * std::sqrt(stage.contact_weight)),
      start_energy_(warm_start.energy) {
    const StepScene& scene = stage.scene;
    if (scene.plan.contacts) law_.begin(warm_start);
    space.cloth_anchors.set(warm_start.cloth_anchors);
    space.friction = {.positions = &stage.start.positions,
                      .fraction = stage.substep.from,
                      .stick_anchors = stage.start.stick_anchors,
                      .obstacle_motions = stage.obstacle_motions,
                      .cloth_anchors = &space.cloth_anchors};
    set_step_springs(
        scene.compute,
        {scene.model.adjacency, stage.start.positions, scene.plan.damping, stage.base.h, stage.rest_length, &scene.model.springs},
        space.springs);
}

void StageEquations::set_start(StagePoint& point) const {
    const StepScene& scene = stage_.scene;
    copy(scene.compute, stage_.start.positions, point.positions);
    copy(scene.compute, stage_.start.velocities, point.velocities);
    if (scene.plan.contacts) point.points = stage_.start.points;
    point.fraction = stage_.moves_are_scripted() ? stage_.substep.from : stage_.substep.to;
}

/// The direction of the first move, m/s. Velocities of the start become (q - q*)/h: what a clamp takes from the move is not
/// stored as energy.
void StageEquations::set_prediction(StagePoint& start, Vec3Arrays& direction) const {
    const StepScene& scene = stage_.scene;
    set_zero(scene.compute, direction, scene.model.vertex_count());
    const double h = stage_.base.h, rate = 1.0 / h;
    set_each(scene.compute, stage_.start.positions, stage_.base.positions, start.velocities,
             [rate](double q, double base) { return rate * q - rate * base; });
    set_each(scene.compute, stage_.start.velocities, start.velocities, direction, [](double v, double now) { return v - now; });
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) continue;
        direction.set(i, (stage_.targets.at(i) - stage_.base.positions.at(i)) / h - start.velocities.at(i));
    }
}

void StageEquations::begin(StagePoint& point, StagePoint& trial, Vec3Arrays& direction) {
    set_start(point);
    if (!stage_.options.predict) return;
    set_prediction(point, direction);
    move(point, direction, 1.0, trial);
    if (stage_.scene.plan.contacts) {
        StageTimer timer(times_.refresh);
        stage_.scene.detector->update_candidates(point.points, trial.points);
    }
    clamp(point, trial);
    std::swap(point, trial);
}

bool StageEquations::starts_too_high(const StagePoint& point, const StagePoint& start) const {
    if (!stage_.scene.plan.contacts || !stage_.options.predict || stage_.projects() || stage_.moves_are_scripted()) return false;
    const double stored = stage_.contact_weight * (point.contact.energy - start_energy_);
    return stored > 0.0 && stored > inertia(start) - inertia(point);
}

void StageEquations::halve_prediction(const StagePoint& start, StagePoint& point) const {
    set_each(stage_.scene.compute, start.velocities, point.velocities, point.velocities,
             [](double from, double to) { return 0.5 * (from + to); });
    place(point);
}

/// J, 1/2 |v - v*|_M^2.
double StageEquations::inertia(const StagePoint& point) const {
    const StepScene& scene = stage_.scene;
    return 0.5 * sum_terms(scene.compute, 0, scene.model.vertex_count(), [&](int i) {
               return scene.script.free[i] * scene.model.mass[i] * square_between(point.velocities, stage_.base.velocities, i);
           });
}

void StageEquations::move(const StagePoint& from, const Vec3Arrays& direction, double factor, StagePoint& to) const {
    set_each(stage_.scene.compute, from.velocities, direction, to.velocities,
             [factor](double v, double dv) { return v + factor * dv; });
    place(to);
    to.fraction = factor == 1.0 ? stage_.substep.to : from.fraction + factor * (stage_.substep.to - from.fraction);
}

void StageEquations::place(StagePoint& point) const {
    const Compute& compute = stage_.scene.compute;
    const double h = stage_.base.h;
    set_each(compute, stage_.base.positions, point.velocities, point.positions, [h](double q, double v) { return q + h * v; });
    if (!stage_.scene.plan.contacts) return;
    point.points.resize(stage_.start.points.size());
    copy_out(compute, point.positions, point.points);
}

double StageEquations::clamp(const StagePoint& from, StagePoint& to) {
    if (!stage_.scene.plan.contacts) return 1.0;
    StageTimer timer(times_.cut);
    const StepFraction substep{from.fraction, to.fraction};
    const double kept = stage_.scene.detector->collision_free_step_size(from.points, to.points, substep);
    smallest_fraction_ = std::min(smallest_fraction_, kept);
    if (kept >= 1.0) return 1.0;
    shorten(stage_.scene.compute, from.velocities, kept, to.velocities);
    place(to);
    if (stage_.moves_are_scripted()) to.fraction = from.fraction + kept * (substep.to - substep.from);
    return kept;
}

void StageEquations::evaluate(StagePoint& point, const StagePoint* accepted) {
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
        add_contact(point, accepted);
    } else {  // terms of a scene that had contact before
        point.constraints.clear();
        point.constraint_forces.clear();
        point.contact.clear();
    }
    set_residual(point);
    if (scene.plan.contacts && !stage_.projects() && point.constraints.size() > 0) {
        const double weight = stage_.contact_weight;
        soften_contact({point.constraints, point.constraint_forces, point.residual, scene.script.free, stage_.base.h, weight},
                       point.contact, space_.loads);
    }
}

/// Sets what projection takes from the first evaluation.
void StageEquations::freeze(const StagePoint& point) {
    if (!stage_.projects()) return;
    fill_diagonal(matrix_, point.forces.spring_terms, space_.frozen.diagonal, space_.frozen.inverse);
    law_.set_constraints(point.constraints);
}

void StageEquations::add_contact(StagePoint& point, const StagePoint* accepted) {
    if (!accepted) freeze(point);
    weigh(stage_.scene.compute, 1.0 / stage_.contact_weight, point.forces);
    law_.evaluate(contact_point(point, accepted), contact_forces(point));
    weigh(stage_.scene.compute, stage_.contact_weight, point.forces);
    largest_stiffness_ = std::max(largest_stiffness_, point.contact.largest_stiffness);
}

ContactPoint StageEquations::contact_point(const StagePoint& point, const StagePoint* accepted) const {
    const StepScene& scene = stage_.scene;
    return {.constraints = point.constraints,
            .positions = point.positions,
            .velocities = point.velocities,
            .step = {.dt = contact_dt_,
                     .obstacle_rate = 1.0 / scene.settings.time_step,
                     .fraction = point.fraction,
                     .mass = &scene.model.mass,
                     .gravity = contact_gravity(scene.settings.gravity),
                     .modulus = &scene.model.modulus,
                     .length = &scene.model.length,
                     .diagonal = &space_.frozen.diagonal,
                     .friction = &space_.friction,
                     .previous = accepted ? &accepted->contact.friction_contacts : nullptr},
            .obstacles_moved = point.fraction - stage_.substep.from};
}

ContactForces StageEquations::contact_forces(StagePoint& point) {
    return {point.forces.total, point.forces.potential, point.contact, point.constraint_forces};
}

bool StageEquations::correct_contact(StagePoint& point, double enough) {
    if (!stage_.scene.plan.contacts || point.constraints.size() == 0) return false;
    StageTimer timer(times_.force);
    if (!law_.correct(contact_point(point, &point), contact_forces(point), enough)) return false;
    set_residual(point);
    return true;
}

void StageEquations::end_contact(const StagePoint& point, ContactWarmStart& warm_start) const {
    if (!stage_.scene.plan.contacts) return;
    law_.end(point.constraints, point.contact, point.constraint_forces, warm_start);
    warm_start.energy = point.contact.energy;
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
