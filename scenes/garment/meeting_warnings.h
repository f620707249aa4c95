#pragma once

#include <span>
#include <string>
#include <vector>

#include "format/scene.h"
#include "percale/mesh.h"

namespace percale::scenes {

/// Warnings of likely mistakes about cloths beside obstacles, which nothing refuses: meshes that look swapped, cloth that can
/// meet no obstacle. `starts`: the cloths of the scene, m; `obstacles`: in the world at the start, m.
std::vector<Finding> meeting_warnings(const Scene& scene, std::span<const TriangleMesh> starts,
                                      std::span<const TriangleMesh> obstacles);

/// What is said of a closed cloth beside an open obstacle.
std::string swapped_text(const std::string& obstacle);

}  // namespace percale::scenes
