#include "explicit_span.h"

#include <cmath>

#include "ledger.h"
#include "schemes/schemes.h"
#include "state_forces.h"
#include "support/stage_timer.h"
#include "targets.h"

namespace percale {
namespace {

void make_step(const Span& span, const StepState& start, Workspace& work, StepState& end) {
    const StepScene& scene = span.scene;
    set_targets(span, span.fraction.to, work.targets);
    begin_end(start, end);
    end.contact_energy = 0.0;
    end.cloth.positions = start.cloth.positions;
    end.cloth.velocities = start.cloth.velocities;
    end.cloth.points.resize(start.cloth.points.size());
    end.cloth.grips = start.cloth.grips;
    end.cloth.impacts = start.cloth.impacts;
    const ExplicitStep step{.scene = scene,
                            .targets = work.targets,
                            .dt = span.length(),
                            .wind = set_wind_at(scene, start.cloth.positions, work),
                            .rest_length = rest_lengths_at(span, 0.5, start, work.rest_length)};
    step_explicit(scene.plan.scheme, step, work.explicit_space, end.cloth);
    set_rest_length(span, start, work.rest_length, end.cloth);
}

/// A step that counts.
void make_kept_step(const Span& span, const StepState& start, Workspace& work, StepState& end, StepEnergy& flows) {
    make_step(span, start, work, end);
    if (span.scene.plan.ledger) account_explicit(span, {start, end}, work, flows);
    flows.work += seam_work(span, start, end.cloth);
}

/// A whole step and two half ones: what they differ by over 2^order - 1 is the error of the latter, which count.
double make_two_steps(const Span& span, const StepState& start, Workspace& work, StepState& end, StepEnergy& flows) {
    make_step(span, start, work, end);
    work.scratch = end.cloth.positions;
    Span first = span, second = span;
    first.fraction.to = second.fraction.from = 0.5 * (span.fraction.from + span.fraction.to);
    make_kept_step(first, start, work, work.half, flows);
    make_kept_step(second, work.half, work, end, flows);
    add_scaled(work.scratch, -1.0, end.cloth.positions);
    return mean_size(span.scene, work.scratch) / (std::pow(2.0, facts_of(span.scene.plan.scheme).order) - 1.0);
}

}  // namespace

SpanResult advance_explicit(const Span& span, const StepState& start, Workspace& work, StepState& end) {
    StageTimer timer(work.times.force);
    SpanResult result;
    if (span.scene.settings.adaptive) {
        result.error = make_two_steps(span, start, work, end, result.flows);
    } else {
        make_kept_step(span, start, work, end, result.flows);
    }
    const auto [pins, wind] = script_work(span.scene, start.cloth, end.cloth, span.length(), work);
    result.flows.work += pins + wind;
    if (span.scene.plan.ledger) result.flows.dissipated_integrator += pins + wind;  // account_explicit
    return result;
}

}  // namespace percale
