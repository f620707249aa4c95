#pragma once

#include <span>
#include <utility>
#include <vector>

#include "geometry/box.h"
#include "geometry/disjoint_sets.h"
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

    /// The group of each cloth, by its lowest member, where `before` says which they were in; empty: none yet. Cloths that may
    /// come into contact join groups. Where groups may part, those of one stay in it that are within their thicknesses, by way
    /// of others, too.
    const std::vector<int>& groups(std::span<const int> before, bool may_part);

private:
    std::vector<Cloth> cloths_;
    std::vector<Box> boxes_, grown_;  // m
    ClusterTree tree_;
    std::vector<std::pair<int, int>> pairs_;
    DisjointSets sets_;
    std::vector<int> groups_;
};

}  // namespace percale
