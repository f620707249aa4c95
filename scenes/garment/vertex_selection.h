#pragma once

#include <string>
#include <vector>

#include "format/scene.h"

namespace percale::scenes {

/// The cloth vertices a selection means, ascending, each once. `mesh` is the cloth as it starts, in world coordinates; a box is
/// given in fractions of its bounding box, and a direction in which the mesh is flat excludes nothing. Throws SceneError for
/// indices out of range, a box without a vertex, or the boundary of a closed mesh.
std::vector<int> select_vertices(const VertexSelection& selection, const TriangleMesh& mesh, const std::string& cloth_name);

}  // namespace percale::scenes
