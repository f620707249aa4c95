#include "step.h"

#include <algorithm>
#include <limits>

#include "checks/checked_terms.h"
#include "compliant/compliant_obstacle.h"
#include "failure.h"
#include "kinetic_damping.h"
#include "measure.h"
#include "motion.h"
#include "plan/planning.h"
#include "sewing.h"
#include "solve_step.h"
#include "step_parts.h"
#include "support/deadline.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Numbers of equal parts into which a step is divided, in turn, where a surface came up too fast to give way in time. Cost
/// alone, but for the last: a surface too fast for it fails the step.
constexpr int compliant_parts[] = {4, 16, 64};

/// Newton iterations of a step whose time is up in which pins and obstacles have to arrive, or the step fails. Smaller: steps
/// fail that would have arrived. Larger: those that do not arrive delay their host for longer.
constexpr int max_late_iterations = 20;

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

/// Renews an outdated plan and sets what moves in this step. Returns the work of added and removed pins, of welds and of strain
/// limits, J.
double plan_step(World& world) {
    StepScene& scene = world.scene;
    const double pins = world.plan_outdated ? renew_plan(scene, world.state.cloth) : 0.0;
    world.plan_outdated = false;
    set_motion_of_step(scene, world.state.cloth, world.state.time);
    return pins + tighten_holds(world);
}

/// Checks the end that was found: it is finite, and no force contradicts its energy.
void check_end(const StepScene& scene, const StepState& start, const StepState& end, const Workspace& work, StepReport& report) {
    if (report.ok() && !all_finite(scene.compute, end.cloth)) report.status = StepStatus::not_finite;
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
    report_obstacles(scene);  // with their targets at the end of the step; nothing moves yet
    Pinches pinches;
    if (any_compliant(scene.script)) {
        pinches = comply_with_cloth(scene, state.cloth);
        set_motion_of_step(scene, state.cloth, state.time);  // where deflections stay nothing may move
    }
    const StepMeasure measure(scene, state, report.energy.work);

    // Explicit, or Newton on the implicit scheme; every move is clamped so that it crosses nothing. The end lies in the
    // workspace; null: the report states why.
    StepState* end = solve_step(scene, state, work, report);
    if (end) check_end(scene, state, *end, work, report);

    if (scene.plan.contacts) world.load_source = report.ok() ? LoadSource::last_solve : LoadSource::nowhere;
    if (report.ok()) {
        std::swap(state, *end);  // `state` is the end of the step from here, the workspace keeps its start
        finish_motion(scene);
        report.pinched = pinches.count;
        report.pinching = pinches.obstacles;
        report.yielded = largest_deflection(scene.script);
        advance_time(dt, state);
        measure.accepted(state, work, report);
        update_rest(scene, end->cloth.velocities, state.cloth, rest, report);
        damp_kinetic_energy(scene, state, rest, report);
    } else {
        for (ObstacleState& obstacle : scene.script.obstacles) obstacle.stay();
        loosen_holds(world);
        state.past.forget();
        wake(rest);
        measure.kept(state, report);
    }
    report.stages = work.times;
    report.time = state.time;
    return report;
}

/// One step divided into parts.
StepReport step_divided(World& world, int parts) {
    StepState& state = world.state;
    const double dt = world.scene.settings.time_step, time = state.time, time_error = state.time_error;
    StepReport report = step_in_parts(world, parts, step_once);
    if (report.ok()) {  // in the order in which one step sums it
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

/// Refuses a step in which an obstacle moves farther than any number of parts allows.
StepReport refuse_far(World& world, const MotionParts& motion) {
    StepReport report = begin_report(world.scene.settings.time_step);
    report_too_far(world.scene, motion, report);
    world.load_source = LoadSource::nowhere;
    StepMeasure(world.scene, world.state, 0.0).kept(world.state, report);
    report.time = world.state.time;
    return report;
}

/// Cloth that sleeps continues to press with the forces at which it fell asleep.
void press_asleep(World& world) {
    const double dt = world.scene.settings.time_step;
    for (const ContactLoad& load : contact_loads(world))
        world.state.impulses[load.obstacle].take(load.cloth_point, dt * load.force());
}

/// Compliant surfaces see cloth only when they are near it: a failed step is made again in shorter parts.
StepReport step_compliant(World& world, int parts, StepReport report) {
    for (const int more : compliant_parts) {
        if (!complies_in_vain(world.scene.script, report) || more <= parts) continue;
        const StepReport before = report;
        if (parts == 1 && more == compliant_parts[0]) world.work.iterations_left -= before.newton_iterations;
        if (world.work.iterations_left <= 0) {
            report.status = StepStatus::work_limit;
            report.out_of_time = false;
            return report;
        }
        report = step_divided(world, more);
        add_work(before, report);
    }
    report.yielded_in_vain = complies_in_vain(world.scene.script, report);
    return report;
}

}  // namespace

void scene_changed(World& world) {
    world.plan_outdated = true;
    world.state.past.forget();  // the states from which schemes would extrapolate
    wake(world.rest);
}

StepReport step(World& world) {
    world.state.impulses.assign(world.keeps_impulses ? world.scene.script.obstacles.size() : 0, {});
    if (world.rest.asleep) {
        advance_time(world.scene.settings.time_step, world.state);
        if (world.keeps_impulses) press_asleep(world);
        return sleep_through(world.rest, world.state.time);
    }
    const int limit = world.scene.settings.work_limit;
    world.work.iterations_left = limit > 0 ? limit : std::numeric_limits<int>::max();
    world.work.time = {deadline_in(world.time_limit, world.cancel), max_late_iterations};
    const MotionParts motion = motion_parts(world.scene, world.state.cloth);
    if (motion.count > max_step_parts) return refuse_far(world, motion);
    StepReport report = motion.count > 1 ? step_divided(world, motion.count) : step_once(world);
    if (any_compliant(world.scene.script)) report = step_compliant(world, motion.count, std::move(report));
    if (motion.jumps) report.jump = motion.travel;
    return report;
}

}  // namespace percale
