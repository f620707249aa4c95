#pragma once

#include "toml_document.h"

namespace percale::scenes {

/// Checks a whole document against scene_keys(): unknown keys, missing required keys, kinds, counts, words and ranges.
/// Throws SceneError at the first fault, in the order of the document, with the nearest valid key or the allowed range.
void check_document(const TomlNode& document);

}  // namespace percale::scenes
