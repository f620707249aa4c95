#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/model.h"
#include "models/skinned_shape.h"
#include "percale/mesh.h"

namespace percale::scenes {

/// A model and its meshes joined, as they stand in the file.
struct JoinedModel {
    Model model;
    TriangleMesh mesh;                  // in units of the file; polygons as triangles (polygon_triangles)
    std::vector<VertexOrigin> origins;  // of each vertex of the mesh; of vertices at one place the first
};

/// Reads a file of any format that models are read from: glTF 2.0 and GLB by our own reader, others by assimp in a process of its
/// own. `part`: a node or mesh that is taken alone; "": all. Throws SceneError naming the file.
JoinedModel read_joined_model(const std::string& file, const std::string& part = {});

/// Vertices as the file has them, node by node. Throws SceneError naming the file for a part that there is not, coordinates that
/// are not finite, and copies of meshes beyond 64 in the mean and 100000 vertices.
JoinedModel join(Model model, const std::string& file, const std::string& part = {});

/// Exporters split vertices at seams of texture or shading, and STL shares none: vertices at one place become one, in the order
/// of first appearance. A vertex and a first one stay apart where `alike` is given and returns false for them.
void weld(JoinedModel& joined, const std::function<bool(int vertex, int first)>& alike = {});

/// Throws SceneError naming the file and the vertex where a coordinate is NaN or infinite.
void check_finite(const Vec3& x, std::size_t vertex, const std::string& file);

}  // namespace percale::scenes
