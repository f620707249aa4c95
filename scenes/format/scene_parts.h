#pragma once

#include "format/toml_document.h"

// One table of a checked document (check_document()) as plain data. What involves several keys or tables is checked here.
// All throw SceneError with the place.
namespace percale::scenes {

ClothSpec read_cloth(const TomlNode& table);
ObstacleSpec read_obstacle(const TomlNode& table);
SeamSpec read_seam(const TomlNode& table);
EventSpec read_event(const TomlNode& table);
std::vector<Expectation> read_expectations(const TomlNode& table);

}  // namespace percale::scenes
