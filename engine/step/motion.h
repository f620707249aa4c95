#pragma once

#include "plan/scene.h"

namespace percale {

/// Tells the detector where obstacles are at the ends of the coming step, where it does not know it yet.
void tell_obstacles(StepScene& scene);

/// After a good step: obstacles stay where they arrived.
void finish_motion(StepScene& scene);

}  // namespace percale
