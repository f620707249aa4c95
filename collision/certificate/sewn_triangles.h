#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"
#include "percale/stitch.h"

namespace percale::certificate {

/// Vertices that are one once the stitches are closed have the same number: that of the lowest.
std::vector<int> closed_vertices(std::size_t count, std::span<const Stitch> stitches);

/// Which triangles of a mesh have a point in common once its stitches are closed, apart from those that share a vertex.
class SewnTriangles {
public:
    /// Throws SceneError for a stitch of a vertex that there is not.
    SewnTriangles(const TriangleMesh& mesh, std::span<const Stitch> stitches);

    bool together(int first, int second) const;

private:
    std::vector<std::vector<int>>
        points_;  // of each triangle, ascending: the points sewn together that it has; empty without any
};

}  // namespace percale::certificate
