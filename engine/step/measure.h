#pragma once

#include "world.h"

namespace percale {

/// Fills the report with what the accepted state is like: energies, strain, speed, contacts.
void measure(World& world);

/// After a failed step: energies, strain and speed of the state that was kept; no contacts, nothing near.
void measure_kept(World& world);

/// Energies of the current state, J; contact as the last step left it.
StepEnergy current_energy(const World& world);

}  // namespace percale
