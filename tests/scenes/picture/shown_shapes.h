#pragma once

#include <vector>

#include "picture/shown.h"

namespace percale::scenes::test {

inline ShownShape shown(const TriangleMesh& mesh, bool is_cloth, const Colour& colour = Colour(0.5f, 0.5f, 0.5f)) {
    return {"shape", is_cloth, mesh, colour};
}

/// Every vertex of a mesh moved.
inline TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
    for (Vec3& x : mesh.vertices) x += by;
    return mesh;
}

/// A square that stands upright and faces +z.
inline TriangleMesh upright(double side, int vertices) {
    TriangleMesh mesh = make_grid(side, side, vertices, vertices);
    for (Vec3& x : mesh.vertices) x = Vec3(x.x(), -x.z(), x.y());
    return mesh;
}

}  // namespace percale::scenes::test
