#pragma once

#include "percale/mesh.h"
#include "tests/support/random.h"

namespace percale::scenes::test {

/// Each triangle with corners of its own, moved by up to `by` along each axis: as scanners write STL.
inline TriangleMesh split_corners(const TriangleMesh& mesh, double by, percale::test::Random& random) {
    TriangleMesh apart;
    for (const Triangle& t : mesh.triangles) {
        const int first = static_cast<int>(apart.vertices.size());
        for (const int v : t) apart.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)] + random.point(by));
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    return apart;
}

}  // namespace percale::scenes::test
