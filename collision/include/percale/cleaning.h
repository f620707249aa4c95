#pragma once

#include "percale/mesh.h"

namespace percale {

/// What the cleaning of an obstacle mesh keeps and drops.
struct CleaningReport {
    int triangles = 0;             // left
    int merged_vertices = 0;       // at exactly the same place as another one
    int degenerate_triangles = 0;  // without area
    int duplicate_triangles = 0;
    int unreferenced_vertices = 0;
    int internal_triangles = 0;  // of a closed mesh: with the solid on both sides, where parts of it overlap
};

/// How every detector cleans this mesh when it is added as an obstacle, or as a deforming one; in the mesh's own coordinates,
/// before any pose. Throws SceneError if nothing is left.
CleaningReport cleaning_report(const TriangleMesh& mesh, bool deforming = false);

}  // namespace percale
