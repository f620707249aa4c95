#pragma once

#include <string>
#include <vector>

#include "format/scene.h"
#include "pattern/pattern_mesh.h"
#include "percale/rest_shape.h"

namespace percale::scenes {

/// A path of the scene file as the program can open it: relative ones start at the scene file's folder.
std::string path_beside(const Scene& scene, const std::string& path);

/// A cloth as it starts: mesh file, meshed pattern or grid at its pose, in m; not yet checked (check_mesh). Throws SceneError for
/// a file that cannot be read.
TriangleMesh start_mesh(const Scene& scene, const ClothSpec& cloth, std::vector<Finding>* warnings = nullptr);

/// What a cloth is made from.
struct ClothShape {
    TriangleMesh start;           // as start_mesh() says
    RestShape rest;               // as rest_shape() says
    std::vector<SewnSeam> seams;  // of a pattern
};

/// Makes all of it; a pattern is meshed once. The start is checked (check_mesh). `warnings`: what is likely a mistake. Throws
/// SceneError.
ClothShape cloth_shape(const Scene& scene, const ClothSpec& cloth, std::vector<Finding>& warnings);

/// The rest shape of a cloth, m, the pose's scale applied, and its direction of warp; empty for a cloth that gives neither.
/// `warnings`: what is likely a mistake. Throws SceneError.
RestShape rest_shape(const Scene& scene, const ClothSpec& cloth, const TriangleMesh& start, std::vector<Finding>& warnings);

}  // namespace percale::scenes
