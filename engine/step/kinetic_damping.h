#pragma once

#include "rest_detection.h"
#include "substep/substep.h"

namespace percale {

/// Called after a good step whose report is measured, with StepSettings::kinetic_damping: stops all cloth if its potential
/// energy, elastic, of gravity and of contact, rose in it without external work. `rest.potential` holds that energy, J, from step
/// to step. The energy removed counts as dissipated by the integrator.
void damp_kinetic_energy(const StepScene& scene, StepState& state, RestState& rest, StepReport& report);

}  // namespace percale
