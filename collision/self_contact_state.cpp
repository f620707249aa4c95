#include <algorithm>

#include "self_contact_lists.h"

namespace percale {

template <class Archive, OfType<SelfList> Value>
void exchange(Archive& archive, Value& list) {
    archive(list.first, list.second, list.begin, list.end, list.travel, list.least_reach, list.thickness);
}

template <class Archive, OfType<SelfPair> Value>
void exchange(Archive& archive, Value& pair) {
    archive.choice(pair.shape, 2);
    archive(pair.vertex, pair.feature, pair.thickness, pair.zone, pair.reach);
}

namespace {

bool below(int number, std::size_t count) { return number >= 0 && static_cast<std::size_t>(number) < count; }

bool is_good(const SelfPair& pair, const ClothSurface& surface, std::size_t vertices) {
    const bool edges = pair.shape == PairShape::edge_edge;
    const bool known = std::all_of(pair.vertex.begin(), pair.vertex.end(), [&](int v) { return below(v, vertices); });
    return known && below(pair.feature[0], edges ? surface.edges.size() : vertices) &&
           below(pair.feature[1], edges ? surface.edges.size() : surface.triangles.size());
}

}  // namespace

void SelfContactLists::save(StateWriter& state) const { state(start_, way_, seen_, lists_, pairs_, made_); }

void SelfContactLists::restore(StateReader& state) {
    state(start_, way_, seen_, lists_, pairs_, made_);
    check(state);
}

void SelfContactLists::check(const StateReader& state) const {
    for (const auto* positions : {&start_, &way_, &seen_}) {
        state.demand(positions->size() == rest_.size(), "a wrong number of vertices");
    }
    for (const SelfList& list : lists_) {
        state.demand(below(list.first, clusters_.size()) && below(list.second, clusters_.size()), "a cluster that there is not");
        state.demand(list.begin <= list.end && list.end <= pairs_.size(), "pairs that there are not");
    }
    for (const SelfPair& pair : pairs_) state.demand(is_good(pair, surface_, rest_.size()), "a pair that there is not");
}

}  // namespace percale
