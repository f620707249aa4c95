#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "percale/cloth_pairs.h"
#include "percale/mesh.h"
#include "percale/stitch.h"

namespace percale {

/// Cloth that meets cloth, as it starts.
struct CrossedCloth {
    std::span<const Triangle> triangles;
    std::span<const double> free;               // 0: stays
    std::span<const Stitch> stitches;           // also of vertices that no triangle has, and those that are still open
    MeetingCloth meeting = {};                  // by the triangles
    const std::atomic<bool>* cancel = nullptr;  // true: no way is looked for any more
};

/// Crossed cloth in which closed stitches are gone: what they join is one vertex.
struct MergedCloth {
    std::vector<int> number;         // of each vertex, that of the lowest it is one with
    std::vector<double> free;        // 0: stays; counts for the lowest
    TriangleMesh mesh;               // of what is one the lowest vertex alone is used
    std::vector<int> triangle = {};  // of each triangle its number in the mesh; -1: it is not there
    /// Those that are left, in numbers of the mesh: open ones, their share 0, and those to points between vertices.
    std::vector<Stitch> stitches = {};
    std::vector<Vec3> joined = {};  // m, where each vertex was when joining was over

    /// Length of edges, m; 0 without any.
    double mean_edge() const;

    /// Where all vertices are, m: what did not move as it was given, if `gaps`; else what is joined in one place.
    std::vector<Vec3> places(std::span<const Vec3> given, bool gaps) const;
};

/// Joins what stitches between two vertices of the triangles hold within `near` edges (of the mean length): in the middle, or at
/// the first that stays. Of triangles that then have the same corners one is left, of those without area none.
MergedCloth merge_sewn(const CrossedCloth& cloth, std::span<const Vec3> positions, double near);

}  // namespace percale
