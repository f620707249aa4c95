#pragma once

#include <string>

#include "format/scene.h"

namespace percale::scenes {

/// Every value that a run of the scene uses, as a JSON object laid out like a scene file, defaults included; SI units.
std::string settings_text(const Scene& scene);

}  // namespace percale::scenes
