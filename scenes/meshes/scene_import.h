#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "percale/mesh.h"

namespace Assimp {
class Importer;
}
struct aiMesh;
struct aiNode;
struct aiScene;

namespace percale::scenes {

/// Where a vertex comes from: number `vertex` of a mesh that hangs on a node.
struct VertexOrigin {
    const aiNode* node = nullptr;
    const aiMesh* mesh = nullptr;
    unsigned vertex = 0;
};

/// A file as assimp reads it, and its meshes joined, as they stand in the file. Moves, and is not copied.
struct ImportedScene {
    std::shared_ptr<Assimp::Importer> importer;  // owns the scene
    const aiScene* scene = nullptr;
    TriangleMesh mesh;                  // in units of the file
    std::vector<VertexOrigin> origins;  // of each vertex of the mesh; of vertices at one place the first
};

/// Reads by assimp, vertices as the file has them. `part`: a node or mesh that is taken alone; "": all. Throws SceneError naming
/// the file.
ImportedScene import_scene(const std::string& file, const std::string& part = {});

/// Exporters split vertices at seams of texture or shading, and STL shares none: vertices at one place become one, in the order
/// of first appearance. Those for which `alike`, where given, is false of a vertex and a first one stay apart.
void weld(ImportedScene& imported, const std::function<bool(int vertex, int first)>& alike = {});

/// Throws SceneError naming the file and the vertex where a coordinate is NaN or infinite.
void check_finite(const Vec3& x, std::size_t vertex, const std::string& file);

/// Names of its animations; of one without a name its number, from 0.
std::vector<std::string> clip_names(const ImportedScene& imported);

}  // namespace percale::scenes
