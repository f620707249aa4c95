#pragma once

#include "world.h"

namespace percale {

/// Makes one time step. A failed one leaves the state as it was.
StepReport step(World& world);

}  // namespace percale
