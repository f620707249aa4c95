#include "kinetic_damping.h"

#include <algorithm>

#include "measure.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Whether a step stops cloth: it does where the potential rose. Where that continues in every second or third step, cloth
/// trembles between two sets of contacts, each met on the way from the other, and then for a while every step does.
bool stops(bool rises, double dt, RestState& rest) {
    if (rest.stopping > 0.0) {
        rest.stopping -= dt;
        return true;
    }
    rest.unrest = rises ? rest.unrest + unrest_of_rise : std::max(0, rest.unrest - 1);
    if (rest.unrest >= max_unrest) {
        rest.unrest = 0;
        rest.stopping = stopping_time;
    }
    return rises;
}

}  // namespace

void damp_kinetic_energy(const StepScene& scene, StepState& state, RestState& rest, StepReport& report) {
    if (!scene.settings.kinetic_damping || rest.asleep) return;
    const StepEnergy energy = scene.plan.measures ? report.energy : energy_of(scene, state);
    const double potential = energy.gravity + energy.elastic;
    const bool driven = scene.plan.something_moves() || scene.settings.wind.value_or(Vec3::Zero()) != Vec3::Zero();
    const bool rises = rest.potential && potential > *rest.potential;
    rest.potential = potential;
    if (driven) {
        rest.unrest = 0;
        rest.stopping = 0.0;
    }
    if (driven || !stops(rises, scene.settings.time_step, rest)) return;
    for (auto* axis : {&state.cloth.velocities.x, &state.cloth.velocities.y, &state.cloth.velocities.z})
        std::fill(axis->begin(), axis->end(), 0.0);
    state.past.forget();
    state.cloth.impacts.clear();  // stopped vertices do not bounce
    report.stopped = true;
    report.energy.kinetic -= energy.kinetic;
    report.energy.dissipated_integrator += energy.kinetic;
    report.largest_speed *= 0.0;  // stays NaN where it is not measured
}

}  // namespace percale
