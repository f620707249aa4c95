#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/finding.h"
#include "format/override.h"
#include "percale/simulation.h"
#include "run/scene_build.h"

namespace percale::scenes {

/// What is wrong with a scene file: every mesh of it, what its keys say together, and, where nothing is refused until then, what
/// building it finds (start, plan, predicted cost). Takes no step. Throws SceneError for an override that is no key, or no value
/// of it.
std::vector<Finding> examine_scene_file(const std::string& file, std::span<const Override> overrides);

/// What is wrong with the meshes of a scene alone: errors of those that cannot be read, and what percale doctor says of the rest.
std::vector<Finding> examine_scene_meshes(const Scene& scene);

/// Warnings of what a run takes beyond an hour, 8 GB of memory or 10 GB of frames.
std::vector<Finding> examine_cost(const BuiltScene& built, const ScenePlan& plan);

}  // namespace percale::scenes
