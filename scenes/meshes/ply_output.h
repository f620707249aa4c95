#pragma once

#include <string>

#include "meshes/mesh_fields.h"
#include "percale/mesh.h"

namespace percale::scenes {

/// Writes a mesh as binary little-endian PLY, x, y, z as double so that the same bits are read back, fields as float properties
/// of vertices and faces; to a temporary name first, then renamed. Throws SceneError where a field has another number of values
/// than there are vertices or triangles, or with the system's reason if the file cannot be written.
void write_ply(const std::string& file, const TriangleMesh& mesh, const MeshFields& fields = {});

}  // namespace percale::scenes
