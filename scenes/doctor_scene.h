#pragma once

#include "doctor.h"

namespace percale::scenes {

/// What is wrong with a scene file: every mesh of it, what its keys say together, and, where nothing is refused until then, what
/// building it finds (start, plan, predicted cost). Takes no step. Throws SceneError for an override that is no key, or no value
/// of it.
std::vector<Finding> examine_scene_file(const std::string& file, std::span<const Override> overrides);

}  // namespace percale::scenes
