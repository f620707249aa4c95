#pragma once

#include <cstdlib>
#include <filesystem>

namespace percale::test {

/// Where body scans lie: the environment variable PERCALE_REAL_MESHES, else the folder named when the tests were built.
inline std::filesystem::path real_mesh_folder() {
    const char* named = std::getenv("PERCALE_REAL_MESHES");
    return named != nullptr ? named : PERCALE_REAL_MESHES;
}

}  // namespace percale::test
