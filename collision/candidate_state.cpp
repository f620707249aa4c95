#include <algorithm>

#include "candidate_lists.h"

namespace percale {

template <class Archive, OfType<Box> Value>
void exchange(Archive& archive, Value& box) {
    archive(box.low, box.high);
}

template <class Archive, OfType<FeatureBounds> Value>
void exchange(Archive& archive, Value& bounds) {
    archive(bounds.reach, bounds.quiet_until);
}

template <class Archive, OfType<ContactPair> Value>
void exchange(Archive& archive, Value& pair) {
    archive.choice(pair.kind, 3);
    archive(pair.cloth, pair.edge_bits, pair.obstacle);
}

template <class Archive, OfType<ListedFeature> Value>
void exchange(Archive& archive, Value& feature) {
    archive(feature.pair, feature.first, feature.count, feature.busy, feature.others);
}

template <class Archive, OfType<ListedPack> Value>
void exchange(Archive& archive, Value& listed) {
    std::uint32_t pack_and_held = listed.pack | static_cast<std::uint32_t>(listed.held) << 24;
    archive(listed.reach, listed.row_reach, pack_and_held);
    if constexpr (Archive::reads) {
        listed.pack = pack_and_held & 0xffffffU;
        listed.held = pack_and_held >> 24;
    }
}

template <class Archive, OfType<ClusterList> Value>
void exchange(Archive& archive, Value& list) {
    archive(list.boxes, list.features, list.bounds, list.packs, list.thickness, list.travel, list.least_reach, list.quiet_until,
            list.inside_until, list.holds, list.version);
}

namespace {

constexpr int settled_later = 0;  // version of lists that are good for the obstacles' poses

/// Whether an order holds every number below `count` once.
bool is_permutation_of(std::span<const int> order, std::size_t count) {
    std::vector<bool> seen(count, false);
    for (const int number : order) {
        if (number < 0 || static_cast<std::size_t>(number) >= count || seen[number]) return false;
        seen[number] = true;
    }
    return order.size() == count;
}

bool is_good(const ListedFeature& feature, std::size_t vertices, const Obstacles& obstacles) {
    const ContactPair& pair = feature.pair;
    const auto cloth = pair.vertices();
    const bool known = std::all_of(cloth.begin(), cloth.end(),
                                   [&](int vertex) { return vertex >= 0 && static_cast<std::size_t>(vertex) < vertices; });
    const bool rest_unused =
        std::all_of(pair.cloth.begin() + pair.cloth_count(), pair.cloth.end(), [](int v) { return v == -1; });
    return known && rest_unused && pair.obstacle >= 0 && static_cast<std::size_t>(pair.obstacle) < obstacles.size();
}

/// Whether the packs are those of the features, one after the other: none is looked at twice.
bool are_in_order(const ClusterList& list) {
    std::size_t next = 0;
    for (const ListedFeature& feature : list.features) {
        if (feature.count <= 0 || feature.first < 0 || static_cast<std::size_t>(feature.first) != next) return false;
        next += static_cast<std::size_t>(feature.count);
    }
    return next == list.packs.size();
}

/// Whether the packs of a feature are of its kind and the marks are of packs that there are.
bool has_good_packs(const ListedFeature& feature, const ClusterList& list, const Obstacles& obstacles) {
    const std::vector<FeaturePack>& packs = obstacles[feature.pair.obstacle]->packs().packs;
    for (int i = feature.first; i < feature.first + feature.count; ++i) {
        const std::size_t number = list.packs[i].pack;
        if (number >= packs.size() || packs[number].kind != feature.pair.kind) return false;
    }
    return feature.count >= 64 || feature.busy >> feature.count == 0;
}

}  // namespace

std::uint64_t scene_hash(const std::vector<Triangle>& triangles, const std::vector<double>& vertex_thickness,
                         const Obstacles& obstacles) {
    StateWriter writer;
    writer(triangles, vertex_thickness);
    for (const auto& obstacle : obstacles) {
        writer(obstacle->surface().triangles, obstacle->friction());
        for (const Vec3& x : obstacle->local_vertices()) writer(x);
    }
    return checksum(writer.take());
}

std::vector<std::array<Pose, 2>> restored_poses(const Obstacles& obstacles, StateReader& state) {
    std::vector<std::array<Pose, 2>> poses;
    for (const auto& obstacle : obstacles) {
        state(poses.emplace_back());
        const double scale = obstacle->start_pose().scale;
        state.demand(poses.back()[0].scale == scale && poses.back()[1].scale == scale, "an obstacle of another size");
    }
    return poses;
}

void CandidateLists::save(const Obstacles& obstacles, StateWriter& state) const {
    const int version = total_version(obstacles);
    std::vector<int> order;
    for (const ClothCluster& cluster : clusters_.clusters) {
        order.insert(order.end(), cluster.triangles.begin(), cluster.triangles.end());
    }
    std::vector<ClusterList> lists = lists_;
    for (ClusterList& list : lists) list.version = list.version == version ? settled_later : -1;
    state(order, lists, seen_, seen_fraction_, anchor_, room_, room_version_ == version, empty_);
}

CandidateLists CandidateLists::restored(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                                        const Obstacles& obstacles, StateReader& state) {
    std::vector<int> order;
    std::vector<ClusterList> saved;
    std::vector<Vec3> seen;
    state(order, saved, seen);
    state.demand(is_permutation_of(order, triangles.size()), "no order of the triangles");
    state.demand(seen.size() == vertex_thickness.size(), "a wrong number of vertices");
    CandidateLists lists(triangles, vertex_thickness, seen, make_clusters(triangles, seen.size(), order));
    state.demand(saved.size() == lists.lists_.size(), "a wrong number of lists");
    lists.lists_ = std::move(saved);
    bool room_is_known = false;
    state(lists.seen_fraction_, lists.anchor_, lists.room_, room_is_known, lists.empty_);
    lists.room_version_ = room_is_known ? settled_later : -1;
    lists.check(obstacles, state);
    return lists;
}

void CandidateLists::settle(const Obstacles& obstacles) {
    const int version = total_version(obstacles);
    for (ClusterList& list : lists_) list.version = list.version == settled_later ? version : -1;
    room_version_ = room_version_ == settled_later ? version : -1;
}

void CandidateLists::check(const Obstacles& obstacles, const StateReader& state) const {
    state.demand(anchor_.empty() || anchor_.size() == seen_.size(), "a wrong number of vertices");
    state.demand(!anchor_.empty() || room_version_ != settled_later, "room about nothing");
    for (std::size_t cluster = 0; cluster < lists_.size(); ++cluster) {
        const ClusterList& list = lists_[cluster];
        state.demand(list.boxes.empty() ? list.features.empty() && list.version != settled_later
                                        : list.boxes.size() == vertices_of(cluster).size(),
                     "a wrong number of boxes");
        state.demand(list.bounds.size() == list.features.size(), "a wrong number of bounds");
        state.demand(are_in_order(list), "packs of no feature");
        for (const ListedFeature& feature : list.features) {
            state.demand(is_good(feature, seen_.size(), obstacles), "a feature that there is not");
            state.demand(has_good_packs(feature, list, obstacles), "a pack that there is not");
        }
    }
}

}  // namespace percale
