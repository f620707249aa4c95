#include "step.h"

#include <cmath>

#include "measure.h"
#include "rest_detection.h"
#include "scripted_motion.h"
#include "solve_step.h"

namespace percale {
namespace {

bool all_finite(const ClothState& state) {
    double sum = 0.0;
    for (const auto* vectors : {&state.positions, &state.velocities}) {
        for (const auto* axis : {&vectors->x, &vectors->y, &vectors->z}) {
            sum += sum_terms(0, static_cast<int>(axis->size()), [&](int i) { return 0.0 * (*axis)[i]; });
        }
    }
    return sum == 0.0;
}

/// Compensated sum (Kahan 1965), so that a thousand steps of 1/1000 s are 1 s.
void advance_time(World& world) {
    const double length = world.settings.time_step - world.time_error;
    const double sum = world.time + length;
    world.time_error = (sum - world.time) - length;
    world.time = sum;
}

}  // namespace

StepReport step(World& world) {
    if (world.rest.asleep) {
        advance_time(world);
        return sleep_through(world);
    }
    world.report = {};
    world.report.dt = world.report.smallest_dt = world.report.largest_dt = world.settings.time_step;
    world.before = world.state;
    set_targets(world);  // where pins and obstacles have to be at the end; nothing moves yet
    solve_step(world);   // explicit update, or Newton on the implicit scheme; every move is cut safe
    if (world.report.ok() && !all_finite(world.state)) world.report.status = StepStatus::not_finite;
    if (world.report.ok()) {
        finish_motion(world);
        advance_time(world);
        measure(world);
        update_rest(world);
    } else {
        world.state = world.before;
        wake(world.rest);
        measure_kept(world);
    }
    world.report.time = world.time;
    return world.report;
}

}  // namespace percale
