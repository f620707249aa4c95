#pragma once

#include <string>
#include <vector>

namespace percale::scenes {

/// A number for every vertex, or every triangle, of a mesh.
struct MeshField {
    std::string name;  // of a property: no spaces
    std::vector<double> values;
};

/// What a mesh carries besides its shape.
struct MeshFields {
    std::vector<MeshField> vertex = {}, triangle = {};
};

}  // namespace percale::scenes
