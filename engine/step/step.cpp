#include "step.h"

#include <algorithm>
#include <limits>

#include "checks/checked_terms.h"
#include "failure.h"
#include "kinetic_damping.h"
#include "measure.h"
#include "motion.h"
#include "plan/planning.h"
#include "sewing.h"
#include "solve_step.h"
#include "step_parts.h"
#include "tolerances.h"

namespace percale {
namespace {

StepReport begin_report(double time_step) {
    StepReport report;
    report.dt = report.smallest_dt = report.largest_dt = time_step;
    return report;
}

/// Compensated sum (Kahan 1965), so that a thousand steps of 1/1000 s are 1 s.
void advance_time(double time_step, StepState& state) {
    const double length = time_step - state.time_error;
    const double sum = state.time + length;
    state.time_error = (sum - state.time) - length;
    state.time = sum;
}

/// Renews an outdated plan and sets what moves in this step. contact_dt, which sets the stiffness of contact, grows at once with
/// the time step and falls gradually. Returns the work of pins that came or went, of welds and of strain limits, J.
double plan_step(World& world) {
    StepScene& scene = world.scene;
    const double pins = world.plan_outdated ? renew_plan(scene, world.state.cloth) : 0.0;
    world.plan_outdated = false;
    set_motion_of_step(scene, world.state.cloth, world.state.time);
    const double dt = scene.settings.time_step;
    if (scene.plan.solve) world.state.contact_dt = std::max(dt, world.state.contact_dt - fastest_contact_shortening * dt);
    return pins + tighten_holds(world);
}

/// Whether the end that was found is one: nothing infinite, no force that contradicts its energy.
void check_end(const StepScene& scene, const StepState& start, const StepState& end, const Workspace& work, StepReport& report) {
    if (report.ok() && !all_finite(end.cloth)) report.status = StepStatus::not_finite;
    if (report.ok() && scene.settings.check_derivatives)
        check_derivatives({scene, start.cloth, end, work, report.smallest_dt}, report);
}

/// One step that is not divided.
StepReport step_once(World& world) {
    StepScene& scene = world.scene;
    StepState& state = world.state;
    RestState& rest = world.rest;
    Workspace& work = world.work;
    const double dt = scene.settings.time_step;
    StepReport report = begin_report(dt);
    work.times = {};
    report.energy.work = plan_step(world);
    tell_obstacles(scene);  // where they have to be at the end of the step; nothing moves yet
    const StepMeasure measure(scene, state, report.energy.work);

    // Explicit, or Newton on the implicit scheme; every move is shortened until it crosses nothing. The end lies in the
    // workspace; null: the report says why.
    StepState* end = solve_step(scene, state, work, report);
    if (end) check_end(scene, state, *end, work, report);

    if (scene.plan.contacts) world.load_source = report.ok() ? LoadSource::last_solve : LoadSource::nowhere;
    if (report.ok()) {
        std::swap(state, *end);  // `state` is the end of the step from here, the workspace keeps its start
        finish_motion(scene);
        advance_time(dt, state);
        measure.accepted(state, work, report);
        update_rest(scene, end->cloth.velocities, state.cloth, rest, report);
        damp_kinetic_energy(scene, state, rest, report);
    } else {
        loosen_holds(world);
        state.past.forget();
        wake(rest);
        measure.kept(state, report);
    }
    report.stages = work.times;
    report.time = state.time;
    return report;
}

/// A step in which an obstacle moves far. Where it moves too far for any number of parts, nothing is tried.
StepReport step_far(World& world, const MotionParts& motion) {
    StepState& state = world.state;
    const double dt = world.scene.settings.time_step, time = state.time, time_error = state.time_error;
    StepReport report = begin_report(dt);
    if (motion.count > most_step_parts) {
        tell_too_far(world.scene, motion, report);
        world.load_source = LoadSource::nowhere;
    } else {
        report = step_in_parts(world, motion.count, step_once);
    }
    if (report.ok()) {  // as one step adds it up
        state.time = time;
        state.time_error = time_error;
        advance_time(dt, state);
    } else {
        StepMeasure(world.scene, state, 0.0).kept(state, report);
    }
    report.dt = dt;
    report.time = state.time;
    return report;
}

}  // namespace

void scene_changed(World& world) {
    world.plan_outdated = true;
    world.state.past.forget();  // what schemes would extrapolate from
    wake(world.rest);
}

StepReport step(World& world) {
    if (world.rest.asleep) {
        advance_time(world.scene.settings.time_step, world.state);
        return sleep_through(world.rest, world.state.time);
    }
    const int limit = world.scene.settings.work_limit;
    world.work.iterations_left = limit > 0 ? limit : std::numeric_limits<int>::max();
    const MotionParts motion = motion_parts(world.scene, world.state.cloth);
    return motion.count > 1 ? step_far(world, motion) : step_once(world);
}

}  // namespace percale
