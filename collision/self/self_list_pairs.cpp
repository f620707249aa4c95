// The pairs of a list.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "self/self_contact_lists.h"
#include "tolerances.h"

namespace percale {
namespace {

Box box_of(std::span<const int> vertices, std::span<const Vec3> positions) {
    Box box;
    for (const int v : vertices) box.add(positions[v]);
    return box;
}

}  // namespace

/// The box of a cluster, and those of all of its features, at most once a cover.
const Box& SelfContactLists::box_of_cluster(int cluster, std::span<const Vec3> from) {
    Boxed& boxed = boxed_[cluster];
    if (boxed.cluster_in != covers_) boxed.box = box_of(clusters_[cluster].all_vertices, from);
    boxed.cluster_in = covers_;
    return boxed.box;
}

void SelfContactLists::set_feature_boxes(int cluster, std::span<const Vec3> from) {
    if (boxed_[cluster].features_in == covers_) return;
    boxed_[cluster].features_in = covers_;
    const Cluster& own = clusters_[cluster];
    for (const int v : own.vertices) vertex_boxes_[v] = {.low = from[v], .high = from[v]};
    for (const int e : own.edges) edge_boxes_[e] = box_of(surface_.edges[e].vertex, from);
    for (const int t : own.triangles) triangle_boxes_[t] = box_of(surface_.triangles[t], from);
}

/// Makes a list anew: all pairs that can come into contact while they move against each other by no more than its room.
void SelfContactLists::fill(SelfList& list, std::span<const Vec3> from) {
    const Cluster &a = clusters_[list.first], &b = clusters_[list.second];
    const Box &box_a = box_of_cluster(list.first, from), &box_b = box_of_cluster(list.second, from);
    const double thickness = 0.5 * (a.thickness + b.thickness), apart = box_a.gap(box_b) - thickness;
    old_pairs_.clear();
    std::copy_if(list.pairs.begin(), list.pairs.end(), std::back_inserter(old_pairs_),
                 [](const SelfPair& pair) { return pair.zone > 0.0; });
    list.pairs.clear();
    list.travel = 0.0;
    list.room = shrink(list) + a.skin + b.skin;
    list.smallest_reach = std::numeric_limits<double>::infinity();
    list.thickness = 0.0;
    if (apart >= list.room) {
        list.room = apart;
        return;
    }
    pair_ = cloth_pairs_.of(a.cloth, b.cloth);
    const bool is_fine = tolerances::contact_of_rest * std::min(a.shortest, b.shortest) < std::max(a.thickness, b.thickness);
    const Reach reach{
        .room = list.room, .limit = 0.5 * (a.thickness + b.thickness) + list.room, .rest_counts = is_fine && a.cloth == b.cloth};
    const bool one = list.first == list.second;
    set_feature_boxes(list.first, from);
    set_feature_boxes(list.second, from);
    find_near(a, box_b, reach.limit, near_first_);
    find_near(b, box_a, reach.limit, near_second_);
    filled_ = &list;
    pair_vertices(near_first_, near_second_, reach, from);
    if (!one) pair_vertices(near_second_, near_first_, reach, from);
    pair_edges(one, reach, from);
    for (const SelfPair& pair : list.pairs) {
        list.smallest_reach = std::min(list.smallest_reach, pair.reach);
        list.thickness = std::max(list.thickness, pair.thickness);
    }
    take_over_zones(list);
}

/// Features of a cluster that come within `limit` of a box.
void SelfContactLists::find_near(const Cluster& cluster, Box other, double limit, Near& near) const {
    other.grow(limit);
    near.vertices.clear();
    near.edges.clear();
    near.triangles.clear();
    for (const int v : cluster.vertices) {
        if (vertex_boxes_[v].overlaps(other)) near.vertices.push_back(v);
    }
    for (const int e : cluster.edges) {
        if (edge_boxes_[e].overlaps(other)) near.edges.push_back(e);
    }
    for (const int t : cluster.triangles) {
        if (triangle_boxes_[t].overlaps(other)) near.triangles.push_back(t);
    }
}

void SelfContactLists::pair_vertices(const Near& points, const Near& faces, Reach reach, std::span<const Vec3> from) {
    for (const int v : points.vertices) {
        Box box = vertex_boxes_[v];
        box.grow(reach.limit);
        for (const int t : faces.triangles) {
            const Triangle& face = surface_.triangles[t];
            if (!box.overlaps(triangle_boxes_[t]) || v == face[0] || v == face[1] || v == face[2]) continue;
            if (reach.rest_counts &&
                vertex_boxes_[v].gap(triangle_boxes_[t]) >= thickness_by_rest(std::array{v}, face) + reach.room) {
                continue;
            }
            consider({.shape = PairShape::point_triangle, .vertex = {v, face[0], face[1], face[2]}, .feature = {v, t}},
                     reach.room, from);
        }
    }
}

/// Edges of the clusters last found near each other; of `one` cluster each pair once.
void SelfContactLists::pair_edges(bool one, Reach reach, std::span<const Vec3> from) {
    for (const int e : near_first_.edges) {
        const auto& [a, b] = surface_.edges[e].vertex;
        Box box = edge_boxes_[e];
        box.grow(reach.limit);
        for (const int f : near_second_.edges) {
            const auto& [c, d] = surface_.edges[f].vertex;
            if ((one && e >= f) || !box.overlaps(edge_boxes_[f]) || a == c || a == d || b == c || b == d) continue;
            if (reach.rest_counts &&
                edge_boxes_[e].gap(edge_boxes_[f]) >= thickness_by_rest(std::array{a, b}, std::array{c, d}) + reach.room) {
                continue;
            }
            consider({.shape = PairShape::edge_edge, .vertex = {a, b, c, d}, .feature = {e, f}}, reach.room, from);
        }
    }
}

/// m, which the thickness of a pair of features of one cloth with these vertices does not exceed: most of what is near each other
/// in a fine cloth is so at rest, and cannot come into contact for that.
double SelfContactLists::thickness_by_rest(std::span<const int> first, std::span<const int> second) const {
    double square = std::numeric_limits<double>::infinity();
    for (const int a : first) {
        for (const int b : second) square = std::min(square, (rest_[a] - rest_[b]).squaredNorm());
    }
    return tolerances::contact_of_rest * std::sqrt(square);
}

/// m, through a seam near the pair; 0 where it is sewn together, infinity without such a seam.
double SelfContactLists::sewn_distance(const SelfPair& pair) const {
    const std::span<const int> vertices = pair.vertex;
    const std::size_t of_first = pair.shape == PairShape::edge_edge ? 2 : 1;
    return sewn_.distance(vertices.first(of_first), vertices.subspan(of_first));
}

/// Sets the thickness of a pair near a seam, by the paths through it between vertices.
void SelfContactLists::set_of_seam(SelfPair& pair) const {
    const bool edges = pair.shape == PairShape::edge_edge;
    double most = 0.0;
    for (int k = 0; k < (edges ? 4 : 3); ++k) {
        const std::array first{pair.vertex[edges ? k / 2 : 0]}, second{pair.vertex[edges ? 2 + k % 2 : 1 + k]};
        pair.of_seam[k] = std::min(pair.thickness, tolerances::contact_of_seam * sewn_.distance(first, second));
        most = std::max(most, pair.of_seam[k]);
    }
    pair.thickness = most;
}

/// Keeps a pair that may come into contact if its distance can shrink by `room`.
void SelfContactLists::consider(SelfPair pair, double room, std::span<const Vec3> from) {
    ++considered_;
    pair.thickness = pair_.thickness.value_or(0.5 * (thickness_[pair.vertex[0]] + thickness_[pair.vertex[3]]));
    pair.reach = self_distance(pair, from);
    if (pair.reach >= pair.thickness + room) return;
    const bool one_cloth = cloth_[pair.vertex[0]] == cloth_[pair.vertex[3]];
    const double through_seam = sewn_distance(pair);
    if (through_seam == 0.0) return;
    if (tolerances::contact_of_seam * through_seam < pair.thickness) set_of_seam(pair);
    if (one_cloth) pair.thickness = std::min(pair.thickness, tolerances::contact_of_rest * self_distance(pair, rest_));
    if (pair.reach < pair.thickness + room) filled_->pairs.push_back(pair);
}

/// What was a contact in the list being replaced stays one.
void SelfContactLists::take_over_zones(SelfList& list) const {
    for (SelfPair& pair : list.pairs) {
        const auto same = [&](const SelfPair& old) { return old.shape == pair.shape && old.feature == pair.feature; };
        const auto found = std::find_if(old_pairs_.begin(), old_pairs_.end(), same);
        if (found == old_pairs_.end()) continue;
        pair.zone = found->zone;
        pair.began_apart = found->began_apart;
    }
}

}  // namespace percale
