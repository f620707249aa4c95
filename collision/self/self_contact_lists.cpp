#include "self/self_contact_lists.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "tolerances.h"

namespace percale {
namespace {

double largest(std::span<const double> list) { return list.empty() ? 0.0 : *std::max_element(list.begin(), list.end()); }

/// m, largest thickness that is said of a pair of the cloth, or of any without one; 0 where nothing is.
double largest_said(const ClothPairs& pairs, std::optional<int> cloth = {}) {
    double thickness = 0.0;
    for (const auto& [cloths, pair] : pairs.said()) {
        if (!cloth || cloths[0] == *cloth || cloths[1] == *cloth) thickness = std::max(thickness, pair.thickness.value_or(0.0));
    }
    return thickness;
}

bool comes_before(const SelfPair& a, const SelfPair& b) { return std::tie(a.shape, a.feature) < std::tie(b.shape, b.feature); }

}  // namespace

SelfContactLists::SelfContactLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                                   const SelfContact& cloth)
    : thickness_(vertex_thickness.begin(), vertex_thickness.end()),
      cloth_(cloth.cloth.begin(), cloth.cloth.end()),
      cloth_pairs_(cloth.pairs),
      rest_(cloth.rest.begin(), cloth.rest.end()),
      surface_(make_cloth_surface(triangles, vertex_thickness.size())),
      sewn_(surface_, cloth.stitches, rest_,
            std::max(largest(vertex_thickness), largest_said(cloth.pairs)) / tolerances::contact_of_seam),
      memory_{.start = rest_,
              .displacement = std::vector<Vec3>(rest_.size(), Vec3::Zero()),
              .seen = rest_,
              .lists = {},
              .pairs = {}} {
    for (int v = 0; v < static_cast<int>(cloth_.size()); ++v) {
        if (cloth_[v] >= 0) vertices_.push_back(v);
    }
    // Cloth by cloth, so that sheets that lie on each other do not share clusters.
    std::vector<int> of_cloth;
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
        const int owner = cloth_[triangles[t][0]];
        if (owner >= 0) of_cloth.push_back(t);
        const bool last = t + 1 == static_cast<int>(triangles.size()) || cloth_[triangles[t + 1][0]] != owner;
        if (!last || of_cloth.empty()) continue;
        add_clusters(owner, of_cloth, cloth.rest);
        of_cloth.clear();
    }
    cluster_boxes_.resize(clusters_.size());
    vertex_boxes_.resize(rest_.size());
    edge_boxes_.resize(surface_.edges.size());
    triangle_boxes_.resize(surface_.triangles.size());
}

void SelfContactLists::add_clusters(int cloth, std::span<const int> triangles, std::span<const Vec3> rest) {
    const double said = largest_said(cloth_pairs_, cloth);
    std::vector<Triangle> corners;
    for (const int t : triangles) corners.push_back(surface_.triangles[t]);
    for (const ClothCluster& made : make_clusters(corners, rest).clusters) {
        Cluster& cluster = clusters_.emplace_back();
        cluster.cloth = cloth;
        cluster.thickness = said;
        cluster.vertices = made.vertices;
        cluster.all_vertices = made.all_vertices;
        for (const int t : made.triangles) cluster.triangles.push_back(triangles[t]);
        for (const auto& [a, b] : made.edges) cluster.edges.push_back(surface_.edge_between(a, b));
        for (const int v : made.all_vertices) cluster.thickness = std::max(cluster.thickness, thickness_[v]);
    }
}

double SelfContactLists::cover(std::span<const Vec3> from, std::span<const Vec3> to) {
    if (memory_.made) {
        set_motion(memory_.seen, from);
        for (SelfList& list : memory_.lists) list.travel += shrink(list);
    }
    std::copy(from.begin(), from.end(), memory_.seen.begin());
    if (memory_.made && covers(from) && covers(to)) return 1.0;
    memory_.made = true;
    double fraction = 1.0;
    old_pairs_ = memory_.pairs;
    std::span<const Vec3> end = to;
    while (!rebuild(from, end, fraction < tolerances::least_covered)) {
        fraction *= 0.5;
        shortened_.resize(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) shortened_[i] = from[i] + fraction * (to[i] - from[i]);
        end = shortened_;
    }
    take_over_zones();
    return fraction;
}

Vec3 SelfContactLists::mean_motion(std::span<const Vec3> from, std::span<const Vec3> to) const {
    Vec3 mean = Vec3::Zero();
    for (const int v : vertices_) mean += to[v] - from[v];
    return mean / static_cast<double>(vertices_.size());
}

/// Whether a state is start + s displacement + t + e; s and t by least squares.
bool SelfContactLists::covers(std::span<const Vec3> positions) const {
    const Vec3 mean = mean_motion(memory_.start, positions);
    double along = 0.0, length = 0.0;
    for (const int v : vertices_) {
        along += memory_.displacement[v].dot(positions[v] - memory_.start[v] - mean);
        length += memory_.displacement[v].squaredNorm();
    }
    const double s = length > 0.0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
    return std::all_of(vertices_.begin(), vertices_.end(), [&](int v) {
        const double skin = tolerances::self_skin * thickness_[v];
        return (positions[v] - memory_.start[v] - mean - s * memory_.displacement[v]).squaredNorm() <= skin * skin;
    });
}

void SelfContactLists::set_motion(std::span<const Vec3> from, std::span<const Vec3> to) {
    for (Cluster& cluster : clusters_) {
        cluster.mean = Vec3::Zero();
        for (const int v : cluster.all_vertices) cluster.mean += to[v] - from[v];
        cluster.mean /= static_cast<double>(cluster.all_vertices.size());
        double square = 0.0;
        for (const int v : cluster.all_vertices) square = std::max(square, (to[v] - from[v] - cluster.mean).squaredNorm());
        cluster.spread = std::sqrt(square);
    }
}

double SelfContactLists::shrink(const SelfList& list) const {
    const Cluster &a = clusters_[list.first], &b = clusters_[list.second];
    return a.spread + b.spread + (a.mean - b.mean).norm();
}

/// Boxes of all features during the move, as seen from the cloth's mean motion.
void SelfContactLists::set_boxes() {
    for (const int v : vertices_) {
        vertex_boxes_[v] = Box{};
        vertex_boxes_[v].add(memory_.start[v]);
        vertex_boxes_[v].add(memory_.start[v] + memory_.displacement[v]);
    }
    const auto box_of = [&](const auto& vertices) {
        Box box;
        for (const int v : vertices) box.add(vertex_boxes_[v]);
        return box;
    };
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
        for (const int e : clusters_[c].edges) edge_boxes_[e] = box_of(surface_.edges[e].vertex);
        for (const int t : clusters_[c].triangles) triangle_boxes_[t] = box_of(surface_.triangles[t]);
        cluster_boxes_[c] = box_of(clusters_[c].all_vertices);
        cluster_boxes_[c].grow((0.5 + tolerances::self_skin) * clusters_[c].thickness);
    }
}

/// Makes all lists anew; false (and lists of no use) if that takes too many pairs, unless `whatever_it_takes`.
bool SelfContactLists::rebuild(std::span<const Vec3> from, std::span<const Vec3> to, bool whatever_it_takes) {
    const long most = whatever_it_takes ? std::numeric_limits<long>::max()
                                        : tolerances::most_self_pairs +
                                              tolerances::most_self_pairs_per_vertex * static_cast<long>(rest_.size());
    const Vec3 mean = mean_motion(from, to);
    for (const int v : vertices_) {
        memory_.start[v] = from[v];
        memory_.displacement[v] = to[v] - from[v] - mean;
    }
    set_motion(from, to);
    set_boxes();
    tree_.refit(cluster_boxes_);
    tree_.find_pairs(cluster_pairs_);
    considered_ = 0;
    memory_.lists.clear();
    memory_.pairs.clear();
    for (const auto& [a, b] : cluster_pairs_) {
        pair_ = cloth_pairs_.of(clusters_[a].cloth, clusters_[b].cloth);
        if (!pair_.contact) continue;
        SelfList list{.first = a, .second = b, .begin = memory_.pairs.size()};
        fill_list(list, from);
        if (list.end > list.begin) memory_.lists.push_back(list);
        if (considered_ > most) return false;
    }
    return true;
}

void SelfContactLists::fill_list(SelfList& list, std::span<const Vec3> from) {
    const Cluster &a = clusters_[list.first], &b = clusters_[list.second];
    const double room = shrink(list) + tolerances::self_skin * (a.thickness + b.thickness);
    const double limit = (0.5 + tolerances::self_skin) * (a.thickness + b.thickness);
    const bool one = list.first == list.second;
    find_near(a, cluster_boxes_[list.second], near_first_);
    find_near(b, cluster_boxes_[list.first], near_second_);
    pair_vertices(near_first_, near_second_, {room, limit}, from);
    if (!one) pair_vertices(near_second_, near_first_, {room, limit}, from);
    pair_edges(one, {room, limit}, from);
    list.end = memory_.pairs.size();
    list.smallest_reach = std::numeric_limits<double>::infinity();
    for (const SelfPair& pair : pairs(list)) {
        list.smallest_reach = std::min(list.smallest_reach, pair.reach);
        list.thickness = std::max(list.thickness, pair.thickness);
    }
}

/// Features of a cluster that come near the box of another, which is grown by that one's half of the limit.
void SelfContactLists::find_near(const Cluster& cluster, const Box& other, Near& near) const {
    Box reach = other;
    reach.grow((0.5 + tolerances::self_skin) * cluster.thickness);
    near.vertices.clear();
    near.edges.clear();
    near.triangles.clear();
    for (const int v : cluster.vertices) {
        if (vertex_boxes_[v].overlaps(reach)) near.vertices.push_back(v);
    }
    for (const int e : cluster.edges) {
        if (edge_boxes_[e].overlaps(reach)) near.edges.push_back(e);
    }
    for (const int t : cluster.triangles) {
        if (triangle_boxes_[t].overlaps(reach)) near.triangles.push_back(t);
    }
}

void SelfContactLists::pair_vertices(const Near& points, const Near& faces, Reach reach, std::span<const Vec3> from) {
    for (const int v : points.vertices) {
        Box box = vertex_boxes_[v];
        box.grow(reach.limit);
        for (const int t : faces.triangles) {
            const Triangle& face = surface_.triangles[t];
            if (!box.overlaps(triangle_boxes_[t]) || v == face[0] || v == face[1] || v == face[2]) continue;
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
            consider({.shape = PairShape::edge_edge, .vertex = {a, b, c, d}, .feature = {e, f}}, reach.room, from);
        }
    }
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
    if (pair.reach < pair.thickness + room) memory_.pairs.push_back(pair);
}

/// What was a contact in the lists being replaced stays one.
void SelfContactLists::take_over_zones() {
    std::vector<SelfPair>& old = old_pairs_;
    std::erase_if(old, [](const SelfPair& pair) { return pair.zone == 0.0; });
    std::sort(old.begin(), old.end(), comes_before);
    for (SelfPair& pair : memory_.pairs) {
        const auto found = std::lower_bound(old.begin(), old.end(), pair, comes_before);
        if (found != old.end() && !comes_before(pair, *found)) {
            pair.zone = found->zone;
            pair.began_apart = found->began_apart;
        }
    }
}

}  // namespace percale
