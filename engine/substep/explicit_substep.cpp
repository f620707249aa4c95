#include "explicit_substep.h"

#include <cmath>

#include "ledger.h"
#include "schemes/schemes.h"
#include "state_forces.h"
#include "support/stage_timer.h"
#include "targets.h"

namespace percale {
namespace {

void make_step(const Substep& substep, const StepState& start, Workspace& work, StepState& end) {
    const StepScene& scene = substep.scene;
    set_targets(substep, substep.fraction.to, work.targets);
    begin_end(start, end);
    end.contact_energy = 0.0;
    end.cloth.positions = start.cloth.positions;
    end.cloth.velocities = start.cloth.velocities;
    end.cloth.points.resize(start.cloth.points.size());
    end.cloth.stick_anchors = start.cloth.stick_anchors;
    end.cloth.impacts = start.cloth.impacts;
    const ExplicitStep step{.scene = scene,
                            .targets = work.targets,
                            .dt = substep.length(),
                            .wind = set_wind_at(scene, start.cloth.positions, work),
                            .rest_length = rest_lengths_at(substep, 0.5, start, work.rest_length)};
    step_explicit(scene.plan.scheme, step, work.explicit_space, end.cloth);
    set_rest_length(substep, start, work.rest_length, end.cloth);
}

/// Makes a step whose result counts.
void make_kept_step(const Substep& substep, const StepState& start, Workspace& work, StepState& end, StepEnergy& flows) {
    make_step(substep, start, work, end);
    if (substep.scene.plan.ledger) account_explicit(substep, {start, end}, work, flows);
    flows.work += seam_work(substep, start, end.cloth);
}

/// Makes a whole step and two half ones: their difference over 2^order - 1 is the error of the latter, which count.
double make_two_steps(const Substep& substep, const StepState& start, Workspace& work, StepState& end, StepEnergy& flows) {
    make_step(substep, start, work, end);
    work.scratch = end.cloth.positions;
    Substep first = substep, second = substep;
    first.fraction.to = second.fraction.from = 0.5 * (substep.fraction.from + substep.fraction.to);
    make_kept_step(first, start, work, work.half, flows);
    make_kept_step(second, work.half, work, end, flows);
    add_scaled(work.scratch, -1.0, end.cloth.positions);
    return mean_size(substep.scene, work.scratch) / (std::pow(2.0, facts_of(substep.scene.plan.scheme).order) - 1.0);
}

}  // namespace

SubstepResult advance_explicit(const Substep& substep, const StepState& start, Workspace& work, StepState& end) {
    StageTimer timer(work.times.force);
    SubstepResult result;
    if (substep.scene.settings.adaptive) {
        result.error = make_two_steps(substep, start, work, end, result.flows);
    } else {
        make_kept_step(substep, start, work, end, result.flows);
    }
    const auto [pins, wind] = script_work(substep.scene, start.cloth, end.cloth, substep.length(), work);
    result.flows.work += pins + wind;
    if (substep.scene.plan.ledger) result.flows.dissipated_integrator += pins + wind;  // account_explicit
    return result;
}

}  // namespace percale
