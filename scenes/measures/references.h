#pragma once

#include <vector>

#include "format/scene.h"

namespace percale::scenes {

/// The vertices of the file that each expectation names, m, nothing for those that name none. `vertices`: of all cloths together.
/// Throws SceneError at the expectation's place for a file that cannot be read or has another number of them.
std::vector<std::vector<Vec3>> read_references(const Scene& scene, std::size_t vertices);

}  // namespace percale::scenes
