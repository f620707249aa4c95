#pragma once

#include <cstdlib>
#include <filesystem>

#include "percale/mesh.h"

namespace percale::test {

/// Folder of body scans: the environment variable PERCALE_REAL_MESHES, else the folder named when the tests were built.
inline std::filesystem::path real_mesh_folder() {
    const char* named = std::getenv("PERCALE_REAL_MESHES");
    return named != nullptr ? named : PERCALE_REAL_MESHES;
}

/// The mesh centred, its longest side 1 m.
inline TriangleMesh unit_size(TriangleMesh mesh) {
    Vec3 low = mesh.vertices[0], high = low;
    for (const Vec3& x : mesh.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    for (Vec3& x : mesh.vertices) x = (x - 0.5 * (low + high)) / (high - low).maxCoeff();
    return mesh;
}

}  // namespace percale::test
