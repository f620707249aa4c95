#pragma once

#include <iosfwd>
#include <string>

#include "meshes/mesh_fields.h"
#include "percale/mesh.h"

namespace percale::scenes {

/// Polygon File Format 1.0: ascii (one element a line), binary_little_endian and binary_big_endian. Takes x, y and z of the
/// element "vertex", numbers of any type, and the list vertex_indices or vertex_index of the element "face", of any whole type;
/// polygons by polygon_triangles. Other elements and properties are passed over, wherever they stand. Vertices are
/// exactly the file's, in its order; coordinates in text and of type double keep their full precision. Throws SceneError with
/// name:line, behind a binary file's header with the name and the element. Counts that the file is too short to hold are refused
/// before memory is taken for them; what is taken is at most some 40 times the file.
TriangleMesh read_ply(std::istream& in, const std::string& name);

/// The numbers that the vertices of a PLY file have besides x, y and z (write_ply), in the order of the file; in binary files
/// they may be infinite or no numbers. Throws SceneError as read_ply does.
MeshFields read_ply_fields(const std::string& file);

}  // namespace percale::scenes
