#pragma once

#include <cstddef>

#include "lists/candidate_lists.h"
#include "lists/pack_measure.h"

namespace percale {

/// A listed pack, and one of its lanes: the items of the passes of a search for contacts.
struct SelectedPack {
    ClusterList* list;
    int index;  // in the list

    const ContactPair& feature() const { return list->features[list->packs.at[index].feature]; }
    int number() const { return static_cast<int>(list->packs.at[index].number); }
};
struct SelectedLane {
    SelectedPack place;
    int lane;
};

/// What the passes over listed packs read.
struct ListedScene {
    std::span<const double> thickness;  // m, of each vertex of the cloth
    const Obstacles& obstacles;

    double thickness_of(const ContactPair& feature) const { return thickness[feature.cloth[0]]; }
    const ObstaclePacks& packs_for(const ContactPair& feature) const { return obstacles[feature.obstacle]->packs(); }
    const PackHull& hull_of(const SelectedPack& at) const { return obstacles[at.feature().obstacle]->hull(at.number()); }
    void fetch_hull(const SelectedPack& at) const { __builtin_prefetch(&packs_for(at.feature()).hulls[at.number()]); }
    ContactPair pair_of(const SelectedLane& at) const {
        const ContactPair& feature = at.place.feature();
        return feature.with(packs_for(feature).packs[at.place.number()], at.lane);
    }
    /// Measures the pairs of a pack, `near`: where they matter, m; raises the bounds of its list.
    PackAnswer measure_pack(const ClothMove& move, const SelectedPack& at, double near) const {
        const ContactPair& feature = at.feature();
        const double own = thickness_of(feature);
        const PlacedPack& placed = obstacles[feature.obstacle]->placed(at.number(), move.fraction.from);
        const PackAnswer answer = measure(feature, move.from, placed, {.near = near, .thickness = own});
        at.list->packs.raise(at.index, static_cast<double>(answer.distance_bound), static_cast<double>(answer.travel_to_contact),
                             own, at.list->travel);
        return answer;
    }
};

/// The places where one of a list's bounds is at most `limit`. Valid until `found` is used again.
inline std::span<const int> packs_up_to(const std::vector<float>& bounds, double limit, std::vector<int>& found) {
    if (found.size() < bounds.size()) found.resize(bounds.size());
    const long count = pack_kernels().find_up_to(bounds.data(), static_cast<long>(bounds.size()), above(limit), found.data());
    return std::span<const int>(found).first(static_cast<std::size_t>(count));
}

inline Box box_of(const ContactPair& feature, std::span<const Vec3> positions) {
    Box box;
    for (const int vertex : feature.vertices()) box.add(positions[vertex]);
    return box;
}

/// Prefetches what is about to be read.
template <class T>
void fetch(const T* first, std::size_t count) {
    const char* from = reinterpret_cast<const char*>(first);
    for (std::size_t byte = 0; byte < count * sizeof(T); byte += 64) __builtin_prefetch(from + byte);
}

}  // namespace percale
