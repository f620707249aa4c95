#pragma once

#include "fields/toml_document.h"
#include "format/override.h"

namespace percale::scenes {

/// Puts one `--set KEY=VALUE` into a parsed document; tables on the way are made where they are missing. In a list, a part of
/// the key is an index or the `name` of an item ("cloth.tablecloth.pin", "gravity.1"). Whether the key means something is not
/// checked here. Throws SceneError with the place "--set KEY" where no such item or fabric is there, or where the key leads
/// through something that is no table or list.
void apply_override(TomlNode& document, const Override& override);

}  // namespace percale::scenes
