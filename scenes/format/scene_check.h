#pragma once

#include "common/fault_list.h"
#include "fields/toml_document.h"

namespace percale::scenes {

/// Checks a whole document against scene_keys(): unknown keys, missing required keys, kinds, counts, words and ranges.
/// A fault is a SceneError with the nearest valid key or the allowed range; faults come in the order of the document, one a
/// value, and what a table lacks behind its own.
void check_document(const TomlNode& document, FaultList& faults);

}  // namespace percale::scenes
