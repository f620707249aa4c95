#include "self/self_contact_state.h"

#include <algorithm>
#include <utility>

#include "geometry/box_state.h"

namespace percale {

template <class Archive, OfType<SelfPair> Value>
void exchange(Archive& archive, Value& pair) {
    archive.choice(pair.shape, 2);
    archive(pair.vertex, pair.feature, pair.record, pair.thickness, pair.reach);
}

template <class Archive, OfType<SelfPairRecord> Value>
void exchange(Archive& archive, Value& record) {
    archive(record.pair, record.seam_activation_distance, record.activation_distance);
}

template <class Archive, OfType<SelfList> Value>
void exchange(Archive& archive, Value& list) {
    archive(list.first, list.second, list.pairs, list.records, list.travel, list.room, list.used_room, list.smallest_reach,
            list.thickness);
}

template <class Archive, OfType<Island> Value>
void exchange(Archive& archive, Value& island) {
    archive(island.cloths, island.lists);
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

/// Whether pairs and records name each other, one for one, and no contact has more than its pair's thickness.
bool has_good_records(const SelfList& list) {
    long with_record = 0;
    for (std::size_t i = 0; i < list.pairs.size(); ++i) {
        const int record = list.pairs[i].record;
        if (record == -1) continue;
        if (!below(record, list.records.size()) || list.records[record].pair != static_cast<int>(i)) return false;
        const double distance = list.records[record].activation_distance;
        if (!(distance >= 0.0 && distance <= list.pairs[i].thickness)) return false;
        ++with_record;
    }
    return with_record == static_cast<long>(list.records.size());
}

/// Checks the lists of an island, whose number each of its clusters has.
void check(const Island& island, int number, std::span<const int> island_of_cluster, const ClothSurface& surface,
           const StateReader& state) {
    const auto has = [&](int cluster) {
        return below(cluster, island_of_cluster.size()) && island_of_cluster[cluster] == number;
    };
    std::pair last(-1, -1);
    for (const SelfList& list : island.lists) {
        const std::pair clusters(list.first, list.second);
        state.demand(clusters > last && list.first <= list.second && has(list.first) && has(list.second),
                     "a cluster that there is not");
        for (const SelfPair& pair : list.pairs) state.demand(is_good(pair, surface), "a pair that there is not");
        state.demand(has_good_records(list), "a record of no pair");
        last = clusters;
    }
}

void check(const SelfListsState& memory, const SelfContactLists& lists, const StateReader& state) {
    state.demand(memory.start.size() == lists.memory().start.size() && memory.seen.size() == memory.start.size(),
                 "a wrong number of vertices");
    state.demand(memory.rooms.size() == lists.cluster_count(), "a wrong number of clusters");
    std::vector<int> island_of_cluster(lists.cluster_count(), -1);
    std::vector<bool> grouped(lists.cloth_count(), false);
    std::size_t cloths = 0;
    int number = 0, last = -1;
    for (const Island& island : memory.islands) {
        state.demand(!island.cloths.empty() && island.cloths.front() > last, "groups out of order");
        last = island.cloths.front();
        for (const int cloth : island.cloths) {
            state.demand(below(cloth, lists.cloth_count()) && !grouped[cloth] && cloth >= last, "a cloth in no group, or in two");
            grouped[cloth] = true;
            for (const int cluster : lists.clusters(cloth)) island_of_cluster[cluster] = number;
        }
        cloths += island.cloths.size();
        check(island, number++, island_of_cluster, lists.surface(), state);
    }
    state.demand(memory.islands.empty() || cloths == lists.cloth_count(), "a cloth in no group, or in two");
}

}  // namespace

void save(const SelfContactLists& lists, StateWriter& state) {
    const SelfListsState& memory = lists.memory();
    state(memory.start, memory.seen, memory.rooms, memory.islands);
}

SelfListsState restored_state(const SelfContactLists& lists, StateReader& state) {
    SelfListsState memory;
    state(memory.start, memory.seen, memory.rooms, memory.islands);
    check(memory, lists, state);
    return memory;
}

}  // namespace percale
