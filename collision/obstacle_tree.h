#pragma once

#include <memory>
#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Axis-parallel box, m.
struct Box {
    Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);

    void add(const Vec3& x) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    void add(const Box& other) {
        low = low.cwiseMin(other.low);
        high = high.cwiseMax(other.high);
    }
    void grow(double by) {
        low.array() -= by;
        high.array() += by;
    }
    bool overlaps(const Box& b) const { return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all(); }
    /// How far apart they are, m; 0 where they overlap.
    double gap(const Box& b) const { return (low - b.high).cwiseMax(b.low - high).cwiseMax(0.0).norm(); }
    bool contains(const Vec3& x) const { return (low.array() <= x.array()).all() && (x.array() <= high.array()).all(); }
};

/// What was found near each box of a batch, one list after the other: that of box i is ids[start[i]] ... ids[start[i + 1] -
/// 1].
struct IdLists {
    std::vector<int> start;
    std::vector<int> ids;
};

/// Finds the triangles of one rigid mesh near boxes: all that a backend does. Every triangle whose own box overlaps the asked
/// box is found; more may be, in any order (the caller filters and sorts). Const calls are thread-safe.
class ObstacleTree {
public:
    virtual ~ObstacleTree() = default;
    virtual void find(std::span<const Box> boxes, IdLists& found) const = 0;
};

/// Makes a tree over a mesh; both spans outlive the tree.
using TreeFactory = std::unique_ptr<ObstacleTree> (*)(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace percale
