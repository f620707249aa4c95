#pragma once

#include "percale/mesh.h"

namespace percale::scenes {

/// A mesh whose vertices within `distance` (m, > 0) of an earlier one that stays have become that one.
struct WeldedMesh {
    TriangleMesh mesh = {};     // vertices in their order
    int joined_vertices = 0;    // that have become others
    int dropped_triangles = 0;  // of which two corners have become one
};

WeldedMesh weld_near(const TriangleMesh& mesh, double distance);

}  // namespace percale::scenes
