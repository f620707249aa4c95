#pragma once

#include "common/fault_list.h"
#include "fields/toml_document.h"

namespace percale::scenes {

/// Checks a whole document against scene_keys(): unknown keys, missing required keys, kinds, counts, words and ranges.
/// A fault is a SceneError with the nearest valid key or the allowed range; faults come in the order of the document, one a
/// value, and what a table lacks behind its own.
void check_document(const TomlNode& document, FaultList& faults);

/// The same of one table of a document alone; `path` is its key in scene_keys(), "step" or "fabric", and how messages name it.
void check_part(const TomlNode& table, const std::string& path, FaultList& faults);

}  // namespace percale::scenes
