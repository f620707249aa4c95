#pragma once

#include "percale/mesh.h"

namespace percale::scenes {

/// A funnel about the y axis: a cone that narrows to a tube, both of one wall thickness across the axis; all lengths in m.
struct Funnel {
    double mouth = 0.35;        // inner radius of the cone's upper rim
    double tube = 0.1;          // inner radius of the tube
    double cone_height = 0.3;   // from y = 0 up
    double tube_length = 0.2;   // from y = 0 down
    double wall = 0.015;        // outer radius less inner radius
    double edge_length = 0.04;  // aimed at along the axis
    int segments_around = 48;   // 3 ... 1000
};

/// The funnel as a watertight mesh, normals outward, open at both ends of the passage. Throws SceneError naming the field and its
/// range.
TriangleMesh make_funnel(const Funnel& funnel = {});

}  // namespace percale::scenes
