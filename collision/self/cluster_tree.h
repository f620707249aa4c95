#pragma once

#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "geometry/box.h"

namespace percale {

/// A complete binary tree of boxes over items 0 ... n - 1 in the order given: good where items that follow each other lie near
/// each other. Refitted, never rebuilt.
class ClusterTree {
public:
    /// Takes the items' boxes; all items if their number has changed.
    void refit(std::span<const Box> boxes);

    /// Finds all pairs (a, b) with a <= b of items whose boxes overlap, (a, a) included, in ascending order. Returns false, and
    /// unusable pairs, where there are more than `max`.
    bool find_pairs(std::vector<std::pair<int, int>>& pairs, long max = std::numeric_limits<long>::max());

private:
    std::vector<Box> nodes_;  // node 1 is the root, the children of k are 2k and 2k + 1; leaves begin at leaves_
    std::size_t leaves_ = 0;
    std::vector<std::pair<std::size_t, std::size_t>> open_;  // nodes of one level
};

}  // namespace percale
