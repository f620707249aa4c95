#pragma once

#include "percale/saved_state.h"

namespace percale {

/// The seal of the bytes of Simulation::save. The version changes whenever their content changes, that of detectors included.
constexpr SealKind state_seal{.name = "PERCALES", .version = 21, .words = "saved state"};

}  // namespace percale
