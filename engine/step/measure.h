#pragma once

#include "world.h"

namespace percale {

/// Fills the report with what the accepted state is like: energies, strain, speed, contacts.
void measure(World& world);

/// Energies of the current state, J; contact as the last step left it.
StepEnergy current_energy(const World& world);

}  // namespace percale
