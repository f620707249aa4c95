#pragma once

#include <string>
#include <vector>

#include "run/run_scene.h"

namespace percale::scenes {

/// Writes the files that `matches` names in a scene, as OBJ or PLY, from a run of it: the cloths at the end, or at the
/// expectation's time. Returns a line for each: "matches drape.obj: written, 1089 vertices", "…: unchanged" where the same bytes
/// are there. Throws SceneError at the expectation's place for another format, for `during`, to which no single shape belongs,
/// and for a time that the run did not reach, or a file named twice, all before the first is written; and where a file cannot be
/// written.
std::vector<std::string> update_references(const BuiltScene& built, const RunResult& result);

}  // namespace percale::scenes
