#pragma once

#include <cstddef>

#include "lists/candidate_lists.h"

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
