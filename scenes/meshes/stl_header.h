#pragma once

#include <string>

namespace percale::scenes {

/// Checks that a binary STL file is long enough for what its header claims, so that nothing downstream takes memory for triangles
/// that do not exist. Throws SceneError.
void check_stl_header(const std::string& file);

}  // namespace percale::scenes
