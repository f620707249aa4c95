#pragma once

#include <string>
#include <vector>

#include "common/finding.h"
#include "meshes/mesh_fields.h"
#include "meshes/obj_file.h"
#include "percale/mesh.h"

namespace percale::scenes {

/// The extension of a file's name in lower case, with its dot.
std::string extension_of(const std::string& file);
/// Whether a file is a mesh by the ending of its name.
bool is_mesh_file(const std::string& file);

/// Reads a mesh file. OBJ, OFF and PLY by our own readers (vertices exactly the file's, in its order; polygons by
/// polygon_triangles), models by read_joined_model: glTF and GLB by our own reader, STL, Collada (DAE), FBX, 3DS, AMF, X3D, DXF,
/// LWO, ASE and X through assimp (float precision; polygons likewise; all parts of the file joined, as they stand in it) with
/// vertices welded by position so that a file's shared vertices are shared again, in the order of first appearance. Coordinates
/// are multiplied by `unit` (m per unit of the file, > 0). Throws SceneError naming the file, and the line for OBJ, OFF and PLY
/// in text: missing or unreadable file, empty, NaN or infinite coordinate, index out of range, no triangles, a header that claims
/// more than the file can hold, another format, copies of parts beyond 64 in the mean and 100000 vertices. `warnings`, where not
/// null, gets what is left out of the file that makes it move. `part`: an object or group of an OBJ file, or a node or mesh of
/// what assimp reads (but STL), that is taken alone, with its own vertices; "": all. `weld`, m: vertices within that of an
/// earlier one become one with it (weld_near), triangles that lose a corner by that are left out, which is warned of; 0: none.
TriangleMesh import_mesh(const std::string& file, double unit = 1.0, std::vector<Finding>* warnings = nullptr,
                         const std::string& part = {}, double weld = 0.0);

/// A mesh and what its file says of its vertices besides where they are: the real properties of a PLY file, of an OBJ file none.
/// Throws SceneError as import_mesh does, and for another format.
TriangleMesh import_mesh_with_fields(const std::string& file, std::vector<MeshField>& fields);

/// A mesh with its texture coordinates, which OBJ files have (vt); vertices times `unit`. Throws SceneError as import_mesh does,
/// and for another format.
TexturedMesh import_textured_mesh(const std::string& file, double unit = 1.0, const std::string& part = {});

}  // namespace percale::scenes
