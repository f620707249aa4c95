#include "self/self_contact_state.h"

#include <algorithm>
#include <functional>

namespace percale {

template <class Archive, OfType<Box> Value>
void exchange(Archive& archive, Value& box) {
    archive(box.low, box.high);
}

template <class Archive, OfType<SelfPair> Value>
void exchange(Archive& archive, Value& pair) {
    archive.choice(pair.shape, 2);
    archive(pair.vertex, pair.feature, pair.thickness, pair.of_seam, pair.zone, pair.began_apart, pair.reach);
}

template <class Archive, OfType<SelfList> Value>
void exchange(Archive& archive, Value& list) {
    archive(list.first, list.second, list.pairs, list.travel, list.room, list.smallest_reach, list.thickness);
}

template <class Archive, OfType<SelfGroup> Value>
void exchange(Archive& archive, Value& group) {
    archive(group.cloths, group.lists);
}

namespace {

bool below(int number, std::size_t count) { return number >= 0 && static_cast<std::size_t>(number) < count; }

/// The vertices of two features, the first -1 where there are no such features.
std::array<int, 4> vertices_of(const SelfPair& pair, const ClothSurface& surface) {
    const auto [first, second] = pair.feature;
    if (pair.shape == PairShape::edge_edge) {
        if (!below(first, surface.edges.size()) || !below(second, surface.edges.size())) return {-1};
        const auto &a = surface.edges[first].vertex, &b = surface.edges[second].vertex;
        return {a[0], a[1], b[0], b[1]};
    }
    if (!below(first, surface.vertex_owner.size()) || !below(second, surface.triangles.size())) return {-1};
    const Triangle& face = surface.triangles[second];
    return {first, face[0], face[1], face[2]};
}

/// Whether a pair is of two features that share no vertex.
bool is_good(const SelfPair& pair, const ClothSurface& surface) {
    if (pair.vertex[0] < 0 || pair.vertex != vertices_of(pair, surface)) return false;
    std::array<int, 4> sorted = pair.vertex;
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

void check(const SelfGroup& group, const SelfContactLists& lists, const StateReader& state) {
    const bool ascending =
        std::adjacent_find(group.cloths.begin(), group.cloths.end(), std::greater_equal<>()) == group.cloths.end();
    state.demand(!group.cloths.empty() && ascending && below(group.cloths.front(), lists.cloth_count()) &&
                     below(group.cloths.back(), lists.cloth_count()),
                 "a cloth that there is not");
    const auto has = [&](int cluster) {
        return std::any_of(group.cloths.begin(), group.cloths.end(), [&](int cloth) {
            const std::span<const int> clusters = lists.clusters(cloth);
            return std::binary_search(clusters.begin(), clusters.end(), cluster);
        });
    };
    std::pair last(-1, -1);
    for (const SelfList& list : group.lists) {
        const std::pair clusters(list.first, list.second);
        state.demand(clusters > last && has(list.first) && has(list.second), "a cluster that there is not");
        for (const SelfPair& pair : list.pairs) state.demand(is_good(pair, lists.surface()), "a pair that there is not");
        last = clusters;
    }
}

void check(const SelfListsMemory& memory, const SelfContactLists& lists, const StateReader& state) {
    const std::size_t vertices = lists.memory().seen.size();
    state.demand(memory.seen.size() == vertices, "a wrong number of vertices");
    state.demand(memory.rooms.size() == lists.cluster_count(), "a wrong number of clusters");
    std::vector<int> in_groups(lists.cloth_count(), 0);
    int last = -1;
    for (const SelfGroup& group : memory.groups) {
        check(group, lists, state);
        state.demand(group.cloths.front() > last, "groups out of order");
        last = group.cloths.front();
        for (const int cloth : group.cloths) ++in_groups[cloth];
    }
    const bool whole = std::all_of(in_groups.begin(), in_groups.end(), [](int times) { return times == 1; });
    state.demand(memory.groups.empty() || whole, "a cloth in no group, or in two");
}

}  // namespace

void save(const SelfContactLists& lists, StateWriter& state) {
    const SelfListsMemory& memory = lists.memory();
    state(memory.seen, memory.rooms, memory.groups);
}

SelfListsMemory restored_memory(const SelfContactLists& lists, StateReader& state) {
    SelfListsMemory memory;
    state(memory.seen, memory.rooms, memory.groups);
    check(memory, lists, state);
    return memory;
}

}  // namespace percale
