#pragma once

#include <string>

#include "format/scene.h"

namespace percale::scenes {

/// Every value that a run of the scene uses, as a JSON object laid out like a scene file, defaults included; SI units.
std::string settings_text(const Scene& scene);

/// The first settings that differ between two such texts, at most three: "step.time_step is 0.01, in the checkpoint 0.02"; ""
/// where all but the number of threads are equal. `where`: "in the checkpoint".
std::string different_settings(const std::string& here, const std::string& saved, const std::string& where);

}  // namespace percale::scenes
