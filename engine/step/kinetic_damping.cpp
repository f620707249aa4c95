#include "kinetic_damping.h"

#include <algorithm>

#include "measure.h"

namespace percale {
void damp_kinetic_energy(const StepScene& scene, StepState& state, RestState& rest, StepReport& report) {
    if (!scene.settings.kinetic_damping || rest.asleep) return;
    const StepEnergy energy = scene.plan.measures ? report.energy : energy_of(scene, state);
    const double potential = energy.gravity + energy.elastic + energy.contact;
    const bool driven = scene.plan.something_moves() || scene.settings.wind.value_or(Vec3::Zero()) != Vec3::Zero();
    const bool rises = rest.potential && potential > *rest.potential;
    rest.potential = potential;
    if (driven || !rises) return;
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
