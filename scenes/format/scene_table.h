#pragma once

#include "fields/field_table.h"
#include "format/scene.h"

// A whole scene file as one table of fields, and the list of keys that follows from it.
namespace percale::scenes {

const FieldTable<Scene>& scene_table();
const FieldTable<Fabric>& fabric_table();
/// [step]: the settings of the steps, and the detector.
const FieldTable<Scene>& step_table();

/// All keys, every table directly before what it holds.
const std::vector<SceneKey>& scene_keys();

/// The key with this path, or null.
const SceneKey* find_scene_key(std::string_view path);

/// The keys directly inside a table ("" = the top of the file), without the table's own path.
std::vector<std::string> keys_inside(std::string_view path);

}  // namespace percale::scenes
