#include "lists/candidate_state.h"

#include <algorithm>

#include "geometry/box_state.h"

namespace percale {

template <class Archive, OfType<ContactPair> Value>
void exchange(Archive& archive, Value& pair) {
    archive.choice(pair.kind, 3);
    archive(pair.cloth, pair.edge_bits, pair.across, pair.obstacle);
}

template <class Archive, OfType<ListedPack> Value>
void exchange(Archive& archive, Value& pack) {
    std::uint32_t number_and_persistent = pack.number | static_cast<std::uint32_t>(pack.persistent) << 24;
    archive(pack.feature, number_and_persistent);
    if constexpr (Archive::reads) {
        pack.number = number_and_persistent & 0xffffffU;
        pack.persistent = number_and_persistent >> 24;
    }
}

template <class Archive, OfType<ListedPacks> Value>
void exchange(Archive& archive, Value& packs) {
    archive(packs.reach, packs.wake, packs.at);
}

/// Exchanges all but the version.
template <class Archive, OfType<ClusterList> Value>
void exchange_contents(Archive& archive, Value& list) {
    archive(list.boxes, list.features, list.packs, list.travel, list.cloth_travel, list.drift, list.spread, list.inside_until);
}

/// Exchanges lists one by one, as put_lists does.
template <OfType<ClusterList> Value>
void exchange(StateReader& state, Value& list) {
    exchange_contents(state, list);
    state(list.version);
}

namespace {

/// The triangles, one cluster after the other.
std::vector<int> order_of(std::span<const ClothCluster> clusters) {
    std::vector<int> order;
    for (const ClothCluster& cluster : clusters) order.insert(order.end(), cluster.triangles.begin(), cluster.triangles.end());
    return order;
}

/// Whether an order holds every number below `count` once.
bool is_permutation_of(std::span<const int> order, std::size_t count) {
    std::vector<bool> seen(count, false);
    for (const int number : order) {
        if (number < 0 || static_cast<std::size_t>(number) >= count || seen[number]) return false;
        seen[number] = true;
    }
    return order.size() == count;
}

bool is_good(const ContactPair& pair, std::size_t vertices, const Obstacles& obstacles) {
    const auto cloth = pair.vertices();
    const bool known = std::all_of(cloth.begin(), cloth.end(),
                                   [&](int vertex) { return vertex >= 0 && static_cast<std::size_t>(vertex) < vertices; });
    const bool rest_unused =
        std::all_of(pair.cloth.begin() + pair.cloth_count(), pair.cloth.end(), [](int v) { return v == -1; });
    const bool across_known = std::all_of(pair.across.begin(), pair.across.end(),
                                          [&](int v) { return v == -1 || (v >= 0 && static_cast<std::size_t>(v) < vertices); });
    return known && rest_unused && across_known && pair.obstacle >= 0 &&
           static_cast<std::size_t>(pair.obstacle) < obstacles.size();
}

/// Whether all arrays are of one length and the packs are those of the features, one after the other.
bool are_in_order(const ClusterList& list) {
    const ListedPacks& packs = list.packs;
    if (packs.wake.size() != packs.size() || packs.at.size() != packs.size()) return false;
    if (packs.size() == 0) return true;
    const auto before = [](const ListedPack& a, const ListedPack& b) { return a.feature < b.feature; };
    return packs.at.front().feature >= 0 && static_cast<std::size_t>(packs.at.back().feature) < list.features.size() &&
           std::is_sorted(packs.at.begin(), packs.at.end(), before);
}

/// Whether every pack exists and is of its feature's kind.
bool has_good_packs(const ClusterList& list, const Obstacles& obstacles) {
    for (std::size_t i = 0; i < list.packs.size(); ++i) {
        const ContactPair& feature = list.features[list.packs.at[i].feature];
        const std::vector<FeaturePack>& packs = obstacles[feature.obstacle]->packs().packs;
        const std::size_t number = list.packs.at[i].number;
        if (number >= packs.size() || packs[number].kind != feature.kind) return false;
    }
    return true;
}

bool has_active_contact(const ClusterList& list) {
    return std::any_of(list.packs.at.begin(), list.packs.at.end(), [](const ListedPack& pack) { return pack.persistent != 0; });
}

void check(const CandidateListsState& memory, const ClothClusters& clusters, const Obstacles& obstacles,
           const StateReader& state) {
    state.demand(memory.anchor.empty() || memory.anchor.size() == memory.seen.size(), "a wrong number of vertices");
    state.demand(!memory.anchor.empty() || memory.room_version != good_version, "room about nothing");
    for (std::size_t cluster = 0; cluster < memory.lists.size(); ++cluster) {
        const ClusterList& list = memory.lists[cluster];
        state.demand(list.boxes.empty() ? list.features.empty() && list.version != good_version
                                        : list.boxes.size() == clusters.clusters[cluster].all_vertices.size(),
                     "a wrong number of boxes");
        for (const ContactPair& feature : list.features) {
            state.demand(is_good(feature, memory.seen.size(), obstacles), "a feature that there is not");
        }
        state.demand(are_in_order(list), "packs of no feature");
        state.demand(has_good_packs(list, obstacles), "a pack that there is not");
    }
}

}  // namespace

std::uint64_t scene_hash(const std::vector<Triangle>& triangles, const std::vector<double>& vertex_thickness,
                         const Obstacles& obstacles) {
    StateWriter writer;
    writer(triangles, vertex_thickness);
    for (const auto& obstacle : obstacles) {
        writer(obstacle->surface().triangles, obstacle->friction());
        for (const Vec3& x : obstacle->local_vertices()) writer(x);
        if (obstacle->deforms()) writer(obstacle->surface().given);
    }
    return checksum(writer.take());
}

void save_motions(const Obstacles& obstacles, StateWriter& state) {
    for (const auto& obstacle : obstacles) {
        state(obstacle->start_pose(), obstacle->end_pose());
        for (const std::span<const Vec3> shape : {obstacle->start_shape(), obstacle->end_shape()}) {
            for (const Vec3& x : shape) state(x);
        }
    }
}

void set_motions(std::span<const SavedMotion> motions, const Obstacles& obstacles) {
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        if (obstacles[i]->deforms()) obstacles[i]->deform(motions[i].start_shape, motions[i].end_shape);
        obstacles[i]->move(motions[i].start, motions[i].end);
    }
}

std::vector<SavedMotion> restored_motions(const Obstacles& obstacles, StateReader& state) {
    std::vector<SavedMotion> motions;
    for (const auto& obstacle : obstacles) {
        SavedMotion& motion = motions.emplace_back();
        state(motion.start, motion.end);
        const double scale = obstacle->start_pose().scale;
        state.demand(motion.start.scale == scale && motion.end.scale == scale, "an obstacle of another size");
        for (auto* shape : {&motion.start_shape, &motion.end_shape}) {
            shape->resize(obstacle->start_shape().size());
            for (Vec3& x : *shape) {
                state(x);
                state.demand(x.allFinite(), "an obstacle that is nowhere");
            }
            obstacle->check_shape(*shape);
        }
    }
    return motions;
}

namespace {

/// Writes lists with versions that only say whether lists are valid for the obstacles as they are.
void put_lists(const std::vector<ClusterList>& lists, int version, StateWriter& state) {
    state(static_cast<std::uint64_t>(lists.size()));
    for (const ClusterList& list : lists) {
        exchange_contents(state, list);
        state(list.version == version ? good_version : no_version);
    }
}

}  // namespace

void save(const CandidateLists& candidates, const Obstacles& obstacles, StateWriter& state) {
    const CandidateListsState& memory = candidates.memory();
    const int version = total_version(obstacles);
    state(order_of(candidates.clusters().clusters));
    put_lists(memory.lists, version, state);
    state(memory.seen, memory.seen_fraction, memory.anchor, memory.room, memory.room_version == version, memory.empty);
}

CandidateLists restored_lists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                              const Obstacles& obstacles, const CandidateLists* known, StateReader& state) {
    std::vector<int> order;
    CandidateListsState memory;
    state(order, memory.lists, memory.seen);
    const bool same_order = known && order == order_of(known->clusters().clusters);
    state.demand(same_order || is_permutation_of(order, triangles.size()), "no order of the triangles");
    state.demand(memory.seen.size() == vertex_thickness.size(), "a wrong number of vertices");
    ClothClusters clusters = same_order ? known->clusters() : make_clusters(triangles, memory.seen.size(), order);
    state.demand(memory.lists.size() == clusters.clusters.size(), "a wrong number of lists");
    bool room_is_known = false;
    state(memory.seen_fraction, memory.anchor, memory.room, room_is_known, memory.empty);
    memory.room_version = room_is_known ? good_version : no_version;
    check(memory, clusters, obstacles, state);
    for (ClusterList& list : memory.lists) {
        CandidateLists::set_smallest_bounds(list);
        list.has_persistent = has_active_contact(list);
    }
    return {triangles, vertex_thickness, std::move(clusters), std::move(memory)};
}

}  // namespace percale
