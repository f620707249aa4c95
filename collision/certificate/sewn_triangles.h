#pragma once

#include <span>
#include <vector>

#include "percale/mesh.h"
#include "percale/stitch.h"

namespace percale::certificate {

/// Vertices that are one once the stitches are closed have the same number: that of the lowest.
std::vector<int> closed_vertices(std::size_t count, std::span<const Stitch> stitches);

/// Which triangles of a mesh meet at a stitch once it is closed: each has a vertex of it. The ends of an edge to which a vertex
/// is sewn are vertices of the stitch: where the sides of a seam have other vertices, triangles of one and the other overlap
/// along it.
class SewnTriangles {
public:
    /// Throws SceneError for a stitch of a vertex that does not exist.
    SewnTriangles(const TriangleMesh& mesh, std::span<const Stitch> stitches);

    bool together(int first, int second) const;

private:
    std::vector<std::vector<int>>
        points_;  // of each triangle, ascending: the points sewn together that it has; empty without any
};

}  // namespace percale::certificate
