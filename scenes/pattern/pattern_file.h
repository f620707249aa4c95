#pragma once

#include <string>

#include "pattern/pattern.h"

namespace percale::scenes {

/// Reads and checks a sewing pattern: .toml is the project's own format, .json GarmentCode's. Throws SceneError.
Pattern read_pattern(const std::string& file);

}  // namespace percale::scenes
