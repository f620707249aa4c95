#pragma once

#include <string>

#include "pattern/pattern.h"

namespace percale::scenes {

/// A pattern in the project's own format (README of this folder). Throws SceneFileError with the place.
Pattern read_pattern_toml(const std::string& file);
Pattern parse_pattern_toml(const std::string& text, const std::string& name);

}  // namespace percale::scenes
