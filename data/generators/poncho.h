#pragma once

#include "percale/mesh.h"

namespace percale::scenes {

/// A flat poncho; all lengths in m.
struct PonchoShape {
    double side = 1.2;            // of the square
    double corner_radius = 0.15;  // of the square's corners; 0 < radius <= side / 2
    double hole_width = 0.26;     // of the elliptical head opening, along x
    double hole_depth = 0.30;     // and along z
    double edge_length = 0.025;   // aimed at; 0.005 ... 0.1
};

/// The poncho in the plane y = 0, centred, normals +y: a rounded square with an elliptical hole, triangles close to
/// equilateral (smallest angle above 30 degrees for the default shape). The hole must leave 4 edge lengths of cloth to the
/// nearest side. Throws SceneError naming the field and its range.
TriangleMesh make_poncho(const PonchoShape& shape = {});

}  // namespace percale::scenes
