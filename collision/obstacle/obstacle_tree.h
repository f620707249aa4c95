#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geometry/box.h"
#include "percale/mesh.h"

namespace percale {

/// The items found near each box of a batch, one list after the other: that of box i is ids[start[i]] ... ids[start[i + 1] - 1].
struct IdLists {
    std::vector<int> start;
    std::vector<int> ids;
};

/// Finds the triangles of one mesh near boxes, the only task of a backend. Every triangle whose own box overlaps the queried box
/// is found; more may be, in any order (the caller filters and sorts). Const calls are thread-safe.
class ObstacleTree {
public:
    virtual ~ObstacleTree() = default;
    virtual void find(std::span<const Box> boxes, IdLists& found) const = 0;
    /// Adapts the tree to new positions of the vertices that it was made over.
    virtual void refit() = 0;
};

/// Makes a tree over a mesh; both spans outlive the tree, at the same place.
using TreeFactory = std::unique_ptr<ObstacleTree> (*)(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
