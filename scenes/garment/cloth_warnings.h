#pragma once

#include <span>
#include <string>
#include <vector>

#include "format/scene.h"
#include "percale/mesh.h"

namespace percale::scenes {

/// Warnings of likely mistakes about cloths as they start, which nothing refuses: an area density that no cloth has, cloths that
/// lie in one place and pass through each other. `starts`: the cloths of the scene, m.
std::vector<Finding> cloth_warnings(const Scene& scene, std::span<const TriangleMesh> starts);

}  // namespace percale::scenes
