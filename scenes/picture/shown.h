#pragma once

#include <string>
#include <vector>

#include "percale/mesh.h"
#include "report/colour.h"

namespace percale::scenes {

/// One mesh of a picture, m, world.
struct ShownShape {
    std::string name;
    bool is_cloth = true;  // its two sides differ, and fields are drawn on it
    TriangleMesh mesh;
    Colour colour = Colour::Constant(0.6f);
    std::vector<double> field = {};  // of the vertices, in the field's unit; may be infinite; empty: the shape has its colour
};

/// What is seen at one time.
struct ShownFrame {
    int index = 0;
    double time = 0.0;  // s
    std::vector<ShownShape> shapes;
};

}  // namespace percale::scenes
