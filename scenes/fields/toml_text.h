#pragma once

#include <string>

#include "fields/toml_document.h"

namespace percale::scenes {

/// A value as TOML on one line, tables inline: parse_toml_value reads the same value back, every bit of its numbers. Throws
/// SceneError for a date, of which a node holds no value.
std::string toml_text(const TomlNode& node);

}  // namespace percale::scenes
