#pragma once

#include <string>
#include <vector>

#include "common/fault_list.h"
#include "common/finding.h"
#include "fields/toml_document.h"
#include "format/override.h"

// Keys that had another name in the release before (SceneKey::former): the former name works and is reported.
namespace percale::scenes {

/// Renames the keys of a table to their present names; `path` is the table's key in scene_keys(), "" the whole document.
/// `warnings` gets one for each key that was renamed. A table that has both names is a fault.
void rename_former_keys(TomlNode& table, const std::string& path, std::vector<Finding>& warnings, FaultList& faults);

/// The override with the present name of its key, and a warning if that is another.
Override with_present_key(Override override, std::vector<Finding>& warnings);

/// The present path of a key that is asked for by its former one, "" if there is none.
std::string present_path(const std::string& former_path);

}  // namespace percale::scenes
