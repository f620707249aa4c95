#pragma once

#include "world.h"

namespace percale {

/// Moves the state over the whole step: an explicit update, or an implicit one in one part, or in halves where one does not
/// converge or cannot follow pins and obstacles; adaptive steps in as many parts as their tolerance asks for. Sets the report's
/// status and figures; the state is undefined after a failure.
void solve_step(World& world);

}  // namespace percale
