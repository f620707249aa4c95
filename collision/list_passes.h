#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>

#include "candidate_lists.h"

namespace percale {

constexpr int most_marked = 64;  // packs of a feature that have a bit each

/// What a pass over many such things is about: a cloth feature of a cluster, one of its packs, one of the lanes.
struct ActiveFeature {
    ClusterList* list;
    int feature;
};
struct SelectedPack {
    ClusterList* list;
    int feature, pack;
};
struct SelectedLane {
    SelectedPack place;
    int lane;
};

/// Calls with the index of every pack that is marked or has no mark.
template <class Action>
void for_busy(const ListedFeature& feature, const Action& action) {
    for (unsigned long busy = feature.busy; busy != 0; busy &= busy - 1) action(feature.first + std::countr_zero(busy));
    for (int i = most_marked; i < feature.count; ++i) action(feature.first + i);
}

/// Asks memory for a vector that is about to be read.
template <class T>
void fetch(const T* first, std::size_t count) {
    const char* from = reinterpret_cast<const char*>(first);
    for (std::size_t byte = 0; byte < count * sizeof(T); byte += 64) __builtin_prefetch(from + byte);
}

inline void fetch(const ClusterList& list) {
    fetch(list.bounds.data(), list.bounds.size());
    fetch(list.features.data(), list.features.size());
}

/// The packs that are to be looked at.
inline void fetch_packs(const ActiveFeature& active) {
    const ListedFeature& feature = active.list->features[active.feature];
    if (static_cast<double>(feature.others.quiet_until) <= active.list->travel) {
        fetch(active.list->packs.data() + feature.first, static_cast<std::size_t>(feature.count));
    } else {
        for_busy(feature, [&](int i) { __builtin_prefetch(&active.list->packs[i]); });
    }
}

}  // namespace percale
