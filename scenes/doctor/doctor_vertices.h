#pragma once

#include <span>
#include <vector>

#include "common/finding.h"
#include "format/scene.h"

namespace percale::scenes {

/// A cloth with the mesh that it starts as.
struct ClothMesh {
    const ClothSpec* spec;
    const TriangleMesh* mesh;
};

/// Vertices that pins and events name and their cloth does not have, of every pin and every event. A cloth that is not
/// among those given is not looked at.
std::vector<Finding> missing_vertices(const Scene& scene, std::span<const ClothMesh> cloths);

}  // namespace percale::scenes
