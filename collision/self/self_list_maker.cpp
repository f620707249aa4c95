#include "self/self_list_maker.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tolerances.h"

namespace percale {
namespace {

/// A list may keep memory for this many elements beside twice what it holds; it reserves half of them, and an eighth of what it
/// holds. Fewer: lists of cloth that hardly moves allocate. Cost alone.
constexpr std::size_t spare_elements = 8;

/// Fraction of the distance at rest below which two features of one cloth are in contact at the latest. Above 1: a mesh finer
/// than its thickness pushes itself apart at rest. Small: a fold closes to nearly nothing at its crease.
constexpr double rest_activation_ratio = 0.5;

/// Minimum activation ratio of two features of one cloth, whatever their distance at rest: sheets of one mesh that lie edge to
/// edge, or split along a line, would have no contact there. 0: only the clamp keeps them apart. Large: a mesh that is this much
/// finer than its thickness pushes itself apart at rest.
constexpr double min_rest_activation_ratio = 0.01;

Box box_of(std::span<const int> vertices, std::span<const Vec3> positions) {
    Box box;
    for (const int v : vertices) box.add(positions[v]);
    return box;
}

/// m, thickness h of two features of one cloth that are `distance` apart at rest.
double thickness_from_rest(double distance, double h) {
    return std::min(h, std::max(rest_activation_ratio * distance, min_rest_activation_ratio * h));
}

/// Copies the pairs that are in contact, with their records.
void keep_contacts(const SelfList& from, SelfList& to) {
    to.pairs.clear();
    to.records.clear();
    for (const SelfPair& pair : from.pairs) {
        if (from.activation_distance(pair) == 0.0) continue;
        const int number = static_cast<int>(to.pairs.size());
        to.records.push_back(from.records[pair.record]);
        to.records.back().pair = number;
        to.pairs.push_back(pair);
        to.pairs.back().record = number;
    }
}

/// Copies elements into existing memory unless it is more than twice what they take, or into slightly more than they take: lists
/// of cloth that hardly moves allocate nothing.
template <class Element>
void transfer(const std::vector<Element>& from, std::vector<Element>& to) {
    const std::size_t count = from.size();
    if (to.capacity() > 2 * count + spare_elements) to = std::vector<Element>();  // `to = {}` would keep it
    if (to.capacity() < count) to.reserve(count + count / 8 + spare_elements / 2);
    to.assign(from.begin(), from.end());
}

}  // namespace

bool SelfCloth::meets(int vertex, int triangle) const {
    const Triangle& corners = surface.triangles[triangle];
    if (vertex == corners[0] || vertex == corners[1] || vertex == corners[2]) return false;
    return sewn_distance(std::array{vertex}, corners) > 0.0;
}

double SelfCloth::sewn_distance(std::span<const int> first, std::span<const int> second) const {
    return sewn.overlap(first, second) ? 0.0 : sewn.distance(first, second);
}

void SelfCloth::forget_boxes() {
    for (SelfCluster& cluster : clusters) cluster.is_boxed = cluster.features_are_boxed = false;
}

void SelfCloth::set_box(int cluster, std::span<const Vec3> positions) {
    SelfCluster& own = clusters[cluster];
    if (!own.is_boxed) own.box = box_of(own.all_vertices, positions);
    own.is_boxed = true;
}

void SelfCloth::set_feature_boxes(int cluster, std::span<const Vec3> positions) {
    SelfCluster& own = clusters[cluster];
    if (own.features_are_boxed) return;
    own.features_are_boxed = true;
    for (const int v : own.vertices) vertex_boxes[v] = {.low = positions[v], .high = positions[v]};
    for (const int e : own.edges) edge_boxes[e] = box_of(surface.edges[e].vertex, positions);
    for (const int t : own.triangles) triangle_boxes[t] = box_of(surface.triangles[t], positions);
}

SelfPairRecord& SelfList::record_of(SelfPair& pair) {
    if (pair.record < 0) {
        pair.record = static_cast<int>(records.size());
        records.push_back({.pair = static_cast<int>(&pair - pairs.data())});
    }
    return records[pair.record];
}

void SelfList::clear(double with_room) {
    pairs = std::vector<SelfPair>();
    records = std::vector<SelfPairRecord>();
    begin(with_room);
}

void SelfList::begin(double with_room) {
    pairs.clear();
    records.clear();
    travel = 0.0;
    room = with_room;
    used_room = 0.0;
    smallest_reach = std::numeric_limits<double>::infinity();
    thickness = 0.0;
}

void SelfList::give_up() {
    SelfList contacts;
    keep_contacts(*this, contacts);
    pairs = std::move(contacts.pairs);
    records = std::move(contacts.records);
    room = -1.0;
}

long SelfListMaker::fill(const SelfCloth& cloth, SelfList& list, std::span<const Vec3> start, std::span<const Vec3> now) {
    cloth_ = &cloth;
    pairs_.clear();
    records_.clear();
    considered_ = 0;
    const SelfCluster &a = cloth.clusters[list.first], &b = cloth.clusters[list.second];
    pair_ = cloth.pairs.of(a.cloth, b.cloth);
    keep_contacts(list, old_);
    list.begin(shrink_of(a, b) + a.skin + b.skin);
    const bool is_fine = rest_activation_ratio * std::min(a.shortest, b.shortest) < std::max(a.thickness, b.thickness);
    const double thickness = 0.5 * (a.thickness + b.thickness);
    const Reach reach{.room = list.room, .thickness = thickness, .rest_counts = is_fine && a.cloth == b.cloth};
    const bool one = list.first == list.second;
    find_near(a, b.box, reach.limit(), near_first_);
    find_near(b, a.box, reach.limit(), near_second_);
    pair_vertices(near_first_, near_second_, reach, start);
    if (!one) pair_vertices(near_second_, near_first_, reach, start);
    pair_edges(one, reach, start);
    for (SelfPair& pair : pairs_) {
        if (now.data() != start.data()) pair.reach = self_distance(pair, now);
        list.smallest_reach = std::min(list.smallest_reach, pair.reach);
        list.thickness = std::max(list.thickness, pair.thickness);
    }
    take_over_activation_distances();
    transfer(pairs_, list.pairs);
    transfer(records_, list.records);
    return considered_;
}

/// Finds features of a cluster that come within `limit` of a box.
void SelfListMaker::find_near(const SelfCluster& cluster, Box other, double limit, Near& near) const {
    other.grow(limit);
    near.vertices.clear();
    near.edges.clear();
    near.triangles.clear();
    for (const int v : cluster.vertices) {
        if (cloth_->vertex_boxes[v].overlaps(other)) near.vertices.push_back(v);
    }
    for (const int e : cluster.edges) {
        if (cloth_->edge_boxes[e].overlaps(other)) near.edges.push_back(e);
    }
    for (const int t : cluster.triangles) {
        if (cloth_->triangle_boxes[t].overlaps(other)) near.triangles.push_back(t);
    }
}

void SelfListMaker::pair_vertices(const Near& points, const Near& faces, Reach reach, std::span<const Vec3> start) {
    for (const int v : points.vertices) {
        Box box = cloth_->vertex_boxes[v];
        box.grow(reach.limit());
        for (const int t : faces.triangles) {
            const Triangle& face = cloth_->surface.triangles[t];
            if (!box.overlaps(cloth_->triangle_boxes[t]) || v == face[0] || v == face[1] || v == face[2]) continue;
            if (reach.rest_counts && cloth_->vertex_boxes[v].gap(cloth_->triangle_boxes[t]) >=
                                         thickness_by_rest(std::array{v}, face, reach.thickness) + reach.room) {
                continue;
            }
            consider({.shape = PairShape::point_triangle, .vertex = {v, face[0], face[1], face[2]}, .feature = {v, t}},
                     reach.room, start);
        }
    }
}

/// Pairs the edges of the clusters last found near each other; of `one` cluster each pair once.
void SelfListMaker::pair_edges(bool one, Reach reach, std::span<const Vec3> start) {
    for (const int e : near_first_.edges) {
        const auto& [a, b] = cloth_->surface.edges[e].vertex;
        Box box = cloth_->edge_boxes[e];
        box.grow(reach.limit());
        for (const int f : near_second_.edges) {
            const auto& [c, d] = cloth_->surface.edges[f].vertex;
            if ((one && e >= f) || !box.overlaps(cloth_->edge_boxes[f]) || a == c || a == d || b == c || b == d) continue;
            if (reach.rest_counts && cloth_->edge_boxes[e].gap(cloth_->edge_boxes[f]) >=
                                         thickness_by_rest(std::array{a, b}, std::array{c, d}, reach.thickness) + reach.room) {
                continue;
            }
            consider({.shape = PairShape::edge_edge, .vertex = {a, b, c, d}, .feature = {e, f}}, reach.room, start);
        }
    }
}

/// m, upper bound of the thickness of a pair of features of one cloth with these vertices: most features near each other in fine
/// cloth are near at rest and hence cannot come into contact.
double SelfListMaker::thickness_by_rest(std::span<const int> first, std::span<const int> second, double max) const {
    double square = std::numeric_limits<double>::infinity();
    for (const int a : first) {
        for (const int b : second) square = std::min(square, (cloth_->rest[a] - cloth_->rest[b]).squaredNorm());
    }
    return thickness_from_rest(std::sqrt(square), max);
}

/// Sets the thickness of a pair near a seam by the paths between vertices through the seam.
void SelfListMaker::set_seam_activation_distance(SelfPair& pair, std::array<double, 4>& seam_activation_distance) const {
    const bool edges = pair.shape == PairShape::edge_edge;
    double max = 0.0;
    for (int k = 0; k < (edges ? 4 : 3); ++k) {
        const std::array first{pair.vertex[edges ? k / 2 : 0]}, second{pair.vertex[edges ? 2 + k % 2 : 1 + k]};
        seam_activation_distance[k] =
            std::min(pair.thickness, tolerances::seam_activation_ratio * cloth_->sewn.distance(first, second));
        max = std::max(max, seam_activation_distance[k]);
    }
    pair.thickness = max;
}

/// Keeps a pair that may come into contact if its distance can shrink by `room`.
void SelfListMaker::consider(SelfPair pair, double room, std::span<const Vec3> start) {
    ++considered_;
    const double thickness =
        pair_.thickness.value_or(0.5 * (cloth_->thickness[pair.vertex[0]] + cloth_->thickness[pair.vertex[3]]));
    pair.thickness = thickness;
    pair.reach = self_distance(pair, start);
    if (pair.reach >= pair.thickness + room) return;
    const bool one_cloth = cloth_->cloth[pair.vertex[0]] == cloth_->cloth[pair.vertex[3]];
    const std::span<const int> vertices = pair.vertex;
    const std::size_t of_first = pair.shape == PairShape::edge_edge ? 2 : 1;
    const double through_seam = cloth_->sewn_distance(vertices.first(of_first), vertices.subspan(of_first));
    if (through_seam == 0.0) return;
    std::array<double, 4> seam_activation_distance = away_from_seams;
    if (tolerances::seam_activation_ratio * through_seam < pair.thickness)
        set_seam_activation_distance(pair, seam_activation_distance);
    if (one_cloth) pair.thickness = std::min(pair.thickness, thickness_from_rest(self_distance(pair, cloth_->rest), thickness));
    if (pair.reach >= pair.thickness + room) return;
    if (seam_activation_distance != away_from_seams) {
        pair.record = static_cast<int>(records_.size());
        records_.push_back({.pair = static_cast<int>(pairs_.size()), .seam_activation_distance = seam_activation_distance});
    }
    pairs_.push_back(pair);
}

/// A contact in the list being replaced stays one.
void SelfListMaker::take_over_activation_distances() {
    for (std::size_t i = 0; i < pairs_.size() && !old_.pairs.empty(); ++i) {
        SelfPair& pair = pairs_[i];
        const auto same = [&](const SelfPair& old) { return old.shape == pair.shape && old.feature == pair.feature; };
        const auto found = std::find_if(old_.pairs.begin(), old_.pairs.end(), same);
        if (found == old_.pairs.end()) continue;
        if (pair.record < 0) {
            pair.record = static_cast<int>(records_.size());
            records_.push_back({.pair = static_cast<int>(i)});
        }
        records_[pair.record].activation_distance = old_.activation_distance(*found);
    }
}

}  // namespace percale
