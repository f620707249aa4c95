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
    const std::atomic<bool>* cancel = nullptr;  // true: the search for a solution ends
};

/// Crossed cloth without closed stitches: the vertices that they join are one.
struct MergedCloth {
    std::vector<int> number;         // of each vertex, that of the lowest vertex merged with it
    std::vector<double> free;        // 0: stays; that of the lowest counts
    TriangleMesh mesh;               // of merged vertices the lowest alone is used
    std::vector<int> triangle = {};  // of each triangle its number in the mesh; -1: it is left out
    /// The remaining stitches, in numbers of the mesh: open ones, their share 0, and those to points between vertices.
    std::vector<Stitch> stitches = {};
    std::vector<Vec3> joined = {};  // m, of each vertex after joining

    /// Mean length of the edges, m; 0 without any.
    double mean_edge() const;

    /// Positions of all vertices, m: if `gaps`, those that did not move are as given; otherwise joined vertices have one place.
    std::vector<Vec3> places(std::span<const Vec3> given, bool gaps) const;
};

/// Joins vertices of the triangles that stitches hold within `near` edges (of the mean length): in the middle, or at the first
/// that stays. Of triangles that then have the same corners one remains, of those without area none.
MergedCloth merge_sewn(const CrossedCloth& cloth, std::span<const Vec3> positions, double near);

}  // namespace percale
