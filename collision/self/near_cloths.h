#pragma once

#include <span>
#include <utility>
#include <vector>

#include "geometry/box.h"
#include "geometry/disjoint_sets.h"
#include "self/cluster_tree.h"

namespace percale {

/// Finds by boxes which cloths come near each other during a move.
class NearCloths {
public:
    /// A cloth's vertices, and its thickness, m: the activation distance of two cloths is at most the mean of their thicknesses.
    struct Cloth {
        std::vector<int> vertices;
        double thickness = 0.0;
    };

    explicit NearCloths(std::vector<Cloth> cloths);

    std::size_t count() const { return cloths_.size(); }
    const std::vector<int>& vertices(int cloth) const { return cloths_[cloth].vertices; }

    /// Sets the linear motion to which later answers refer.
    void set_motion(std::span<const Vec3> from, std::span<const Vec3> to);

    /// The island of each cloth, named by its lowest member. `before`: the islands so far; empty: none yet. Islands of cloths
    /// that may come into contact are joined. Where islands may part, cloths within their thicknesses stay together, also through
    /// others.
    const std::vector<int>& islands(std::span<const int> before, bool may_part);

private:
    std::vector<Cloth> cloths_;
    std::vector<Box> boxes_, grown_;  // m
    ClusterTree tree_;
    std::vector<std::pair<int, int>> pairs_;
    DisjointSets sets_;
    std::vector<int> islands_;
};

}  // namespace percale
