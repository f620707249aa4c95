#pragma once

#include <span>
#include <string>
#include <vector>

#include "percale/mesh.h"

namespace percale::scenes {

/// An OBJ file but for where its vertices are: its polygons, texture coordinates, groups, materials, colours and whatever else
/// its lines say, in their order. Normals are left out, since they turn with the shape, and comments. Where a polygon has more
/// than three corners, a comment `#percale corners 0 1 2 0 2 3` behind it names its triangles by the numbers of its corners: a
/// reader would divide it otherwise once it has bent.
class ObjLayout {
public:
    /// Throws SceneError as read_obj does.
    explicit ObjLayout(const std::string& file);

    /// Whether a mesh has this file's vertices and triangles.
    bool fits(const TriangleMesh& mesh) const;
    /// The file with these vertices, as many as it has, to be written into `folder`: there the names of its material libraries
    /// lead to the files beside this one.
    std::string text(std::span<const Vec3> vertices, const std::string& folder) const;

private:
    enum class Kind { vertex, other, library };
    struct Line {
        Kind kind = Kind::other;
        std::string text;  // of a vertex what follows its coordinates; of a library its name as in the file
    };
    void add_face(std::string_view corners, std::size_t& next_triangle);
    std::string library_name(const std::string& name, const std::string& folder) const;

    std::string file_;
    std::vector<Line> lines_;
    std::size_t vertices_ = 0;
    std::vector<Triangle> triangles_;
};

}  // namespace percale::scenes
