#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/scene_file_error.h"
#include "fields/toml_document.h"
#include "format/override.h"
#include "format/scene.h"

namespace percale::scenes {

/// Reads a TOML scene file, overrides applied before anything is checked. Throws SceneError with "file:line:column: what", the
/// allowed range or the nearest valid key. Keys and ranges: scene_table.h.
Scene load_scene(const std::string& file, std::span<const Override> overrides = {});

/// The same from text; `name` stands for the file in messages and relative paths are relative to its folder.
Scene parse_scene(const std::string& text, const std::string& name, std::span<const Override> overrides = {});

/// The same from a document that was not read from a text; `name` as above. Its places are those of messages.
Scene scene_of_document(const TomlNode& document, const std::string& name, std::span<const Override> overrides = {});

/// A scene with overrides applied to what it is read from; throws SceneError as load_scene does.
using SceneSource = std::function<Scene(std::span<const Override>)>;

/// What load_scene has against a file, one kind at a time: all faults of keys and values; where there are none, those of whole
/// tables; where there are none, those of names by which tables refer to each other.
std::vector<SceneFileError> scene_faults(const std::string& file, std::span<const Override> overrides = {});

}  // namespace percale::scenes
