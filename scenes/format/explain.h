#pragma once

#include <iosfwd>
#include <string>

namespace percale::scenes {

/// Prints scene keys with kind, unit, range, default and sentence: all of them for "", else those at or below the topic, which
/// is a path ("step", "cloth.pin") or the last part of one ("time_step"). Throws SceneError for a topic that is none, with the
/// nearest. The topic "presets" lists the fabrics of fabric_presets.h with their numbers and sources.
void explain(std::ostream& out, const std::string& topic = "");

/// The same for scenes/scene_keys.md: one Markdown table for the top of the file and one for each of its tables.
std::string key_tables_markdown();

}  // namespace percale::scenes
