#pragma once

#include <span>

#include "format/scene.h"
#include "percale/plan.h"

namespace percale::scenes {

/// Throws SceneError with its place for what keeps a scene with duration = "rest" from ever being proven at rest: a scheme or
/// setting under which no cloth falls asleep, an obstacle that spins, or what is still to happen at `max_duration`. Others pass.
void check_can_rest(const Scene& scene, const ScenePlan& plan);

/// The same for obstacles that bend: when each keeps its shape, s.
void check_shapes_end(const Scene& scene, std::span<const double> ends);

}  // namespace percale::scenes
