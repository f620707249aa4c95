#pragma once

#include <limits>
#include <span>
#include <vector>

#include "lists/list_passes.h"

namespace percale {

/// Finds the contact constraints of some clusters. Each pass prefetches for the next places, as the data exceed the nearest
/// caches. One for each thread.
class ConstraintSearch {
public:
    ContactConstraints constraints;  // where they do not go to the caller's at once
    double smallest_distance = std::numeric_limits<double>::infinity();

    /// Positions of the cloth, and the fraction of the step at which obstacles are.
    struct Place {
        std::span<const Vec3> positions;
        double fraction;
    };
    void run(const ListedScene& scene, std::span<ClusterList* const> clusters, const Place& place, ContactConstraints& to);

private:
    void find_candidates(std::span<ClusterList* const> clusters);
    void select_packs(const ListedScene& scene, std::span<const Vec3> positions);
    void measure_selected(const ListedScene& scene, const ClothMove& here);
    void fetch_ahead(const ListedScene& scene, std::size_t lane) const;

    std::vector<int> found_;
    std::vector<SelectedPack> candidates_, selected_;
    std::vector<SelectedLane> lanes_;
};

}  // namespace percale
