#pragma once

#include <span>
#include <string>

#include "percale/mesh.h"

namespace percale::scenes {

/// Throws SceneError: the file has no such object or group with faces; `known`: those that it names.
[[noreturn]] void fail_without_part(const std::string& file, const std::string& part, std::span<const std::string> known);

/// Leaves out vertices that no triangle has; the others keep their order.
void drop_unused_vertices(TriangleMesh& mesh);

}  // namespace percale::scenes
