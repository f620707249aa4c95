#pragma once

#include <string>

namespace percale::scenes {

/// Checks that a PLY or STL file is long enough for what its header claims, so that nothing downstream takes memory for elements
/// that do not exist or makes them up. `extension` is ".ply" or ".stl"; other files pass. Throws SceneError.
void check_mesh_header(const std::string& file, const std::string& extension);

}  // namespace percale::scenes
