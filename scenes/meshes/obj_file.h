#pragma once

#include <array>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "percale/mesh.h"

namespace percale::scenes {

/// Wavefront OBJ: v and f (with or without /vt/vn, negative indices allowed, polygons by polygon_triangles); other
/// keywords are passed over. Vertex order is kept. `part`: of the faces those of the object (o) or group (g) of that name alone,
/// and their vertices; "": all. A comment `#percale corners ...` behind a face says how it is cut (ObjLayout). Throws SceneError
/// with name:line.
TriangleMesh read_obj(std::istream& in, const std::string& name, const std::string& part = {});

/// A mesh and its texture coordinates: those of the three corners of every triangle.
struct TexturedMesh {
    TriangleMesh mesh;
    std::vector<std::array<Eigen::Vector2d, 3>> uv;
};

/// The same with vt, of which every corner of every face must have one; throws SceneError with name:line where not.
TexturedMesh read_textured_obj(std::istream& in, const std::string& name, const std::string& part = {});

/// A line `v x y z` without its end; each coordinate has as many digits (at most 17) as it takes to read back the same bits.
std::string& append_obj_vertex(std::string& text, const Vec3& x);

/// Writes v and f; to a temporary name first, then renamed. Each coordinate has as many digits (at most 17) as it takes to read
/// back the same bits. Throws SceneError with the system's reason if the file cannot be written.
void write_obj(const std::string& file, std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale::scenes
