#pragma once

#include "percale/saved_state.h"

namespace percale {

/// Of the bytes of Simulation::save. The version is another as soon as they say more or other things, those of detectors
/// included.
constexpr SealKind state_seal{.name = "PERCALES", .version = 17, .words = "saved state"};

}  // namespace percale
