#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "percale/mesh.h"
#include "tests/support/real_meshes.h"

namespace percale::test {

/// The triangles of an OFF file; nothing if there is no such file or it is truncated.
inline std::optional<TriangleMesh> read_off(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string magic;
    std::size_t vertices = 0, faces = 0, edges = 0;
    if (!(file >> magic >> vertices >> faces >> edges) || magic != "OFF") return std::nullopt;
    TriangleMesh mesh;
    mesh.vertices.resize(vertices);
    for (Vec3& x : mesh.vertices) file >> x.x() >> x.y() >> x.z();
    for (std::size_t i = 0; i < faces; ++i) {
        int corners = 0;
        Triangle t{};
        file >> corners >> t[0] >> t[1] >> t[2];
        if (corners != 3) return std::nullopt;
        mesh.triangles.push_back(t);
    }
    if (!file) return std::nullopt;
    return mesh;
}

}  // namespace percale::test
