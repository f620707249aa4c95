#pragma once

#include <string>
#include <vector>

#include "format/scene.h"
#include "percale/rest_shape.h"

namespace percale::scenes {

/// Elements that modelling leaves in a mesh and that cloth cannot have, by number, ascending.
struct Leftovers {
    std::vector<int> vertices;   // of no triangle
    std::vector<int> triangles;  // with the corners of an earlier one, in any order

    bool any() const { return !vertices.empty() || !triangles.empty(); }
    /// "3 vertices of no triangle and 1 repeated triangle"
    std::string text() const;
};
Leftovers leftovers_of(const TriangleMesh& mesh);

/// Removes the leftovers from a cloth's mesh and from its rest shape; what stays keeps its order. They must be of that mesh.
void drop_leftovers(const Leftovers& leftovers, TriangleMesh& start, RestShape& rest);

/// The part of a scene that names vertices of a cloth by number, which changes where earlier vertices are left out: "pin",
/// "[[event]]", "[[seam]]"; "" if there is none.
std::string numbered_use(const Scene& scene, const ClothSpec& cloth);

}  // namespace percale::scenes
