#pragma once

#include <string>
#include <vector>

#include "format/scene.h"
#include "percale/rest_shape.h"

namespace percale::scenes {

/// What modelling leaves in a mesh and cloth cannot have: by number, ascending.
struct Leftovers {
    std::vector<int> vertices;   // of no triangle
    std::vector<int> triangles;  // with the corners of an earlier one, in any order

    bool any() const { return !vertices.empty() || !triangles.empty(); }
    /// "3 vertices of no triangle and 1 repeated triangle"
    std::string text() const;
};
Leftovers leftovers_of(const TriangleMesh& mesh);

/// Leaves them out of a cloth's mesh and of its rest shape; what stays keeps its order. They must be of that mesh.
void drop_leftovers(const Leftovers& leftovers, TriangleMesh& start, RestShape& rest);

/// What of a scene names vertices of a cloth by their numbers, which change where earlier vertices are left out: "pin",
/// "[[event]]", "[[seam]]"; nothing where it is none.
std::string numbered_use(const Scene& scene, const ClothSpec& cloth);

}  // namespace percale::scenes
