#pragma once

#include <iosfwd>
#include <string>

#include "percale/mesh.h"

namespace percale::scenes {

/// Object File Format, text: OFF, COFF, NOFF, CNOFF and ST before them (normals, colours and texture coordinates are passed
/// over), the keyword left out, counts on the keyword's line, comments; one vertex or face a line; polygons by
/// polygon_triangles. Vertices are exactly the file's, in its order. Throws SceneError with name:line; counts that the file is
/// too short to hold are refused before memory is taken for them.
///
/// Not left to assimp: it replaces an index out of range by the last vertex, fills a file that ends early with made-up
/// coordinates, and rounds to float.
TriangleMesh read_off(std::istream& in, const std::string& name);

}  // namespace percale::scenes
