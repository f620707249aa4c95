#pragma once

#include <span>
#include <utility>
#include <vector>

#include "geometry/box.h"
#include "self/cluster_tree.h"

namespace percale {

/// Which cloths come near each other during a move, by their boxes.
class NearCloths {
public:
    /// A cloth's vertices, and its thickness: two come into contact no farther apart than the mean of theirs, m.
    struct Cloth {
        std::vector<int> vertices;
        double thickness = 0.0;
    };

    explicit NearCloths(std::vector<Cloth> cloths);

    std::size_t count() const { return cloths_.size(); }
    const std::vector<int>& vertices(int cloth) const { return cloths_[cloth].vertices; }

    /// The straight line that later answers are about.
    void set_motion(std::span<const Vec3> from, std::span<const Vec3> to);

    /// Pairs (a, b) with a < b of cloths that may come into contact, in ascending order.
    const std::vector<std::pair<int, int>>& meeting();

    /// Divides some cloths, in ascending order, into groups; two that come within their thicknesses are in one. Groups stand in
    /// the order of their first cloths.
    std::vector<std::vector<int>> groups(std::span<const int> cloths);

private:
    const std::vector<std::pair<int, int>>& near_pairs(double grown);

    std::vector<Cloth> cloths_;
    std::vector<Box> boxes_, grown_boxes_;  // m
    ClusterTree tree_;
    std::vector<std::pair<int, int>> pairs_;
};

}  // namespace percale
