#include "self/self_contact_lists.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
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

/// The numbers of cloths that meet cloth, ascending.
std::vector<int> meeting_cloths(std::span<const int> cloth_of_vertex) {
    std::vector<int> numbers(cloth_of_vertex.begin(), cloth_of_vertex.end());
    std::erase_if(numbers, [](int number) { return number < 0; });
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
}

int place_in(std::span<const int> ascending, int number) {
    return static_cast<int>(std::lower_bound(ascending.begin(), ascending.end(), number) - ascending.begin());
}

/// m, how far each vertex may be from what the lists hold for.
std::vector<double> skins(const ClothSurface& surface, std::span<const Vec3> rest, std::span<const double> thickness) {
    std::vector<double> lengths(rest.size(), 0.0), edges(rest.size(), 0.0);
    for (const ClothSurface::Edge& edge : surface.edges) {
        for (const int v : edge.vertex) {
            lengths[v] += (rest[edge.vertex[0]] - rest[edge.vertex[1]]).norm();
            edges[v] += 1.0;
        }
    }
    std::vector<double> skins(rest.size());
    for (std::size_t v = 0; v < skins.size(); ++v) {
        skins[v] = tolerances::self_skin * thickness[v];
        if (edges[v] > 0.0) skins[v] = std::min(skins[v], tolerances::self_skin_of_edge * lengths[v] / edges[v]);
    }
    return skins;
}

NearCloths near_cloths(const SelfContact& cloth, std::span<const double> thickness) {
    const std::vector<int> numbers = meeting_cloths(cloth.cloth);
    std::vector<NearCloths::Cloth> cloths(numbers.size());
    for (std::size_t c = 0; c < cloths.size(); ++c) cloths[c].thickness = largest_said(cloth.pairs, numbers[c]);
    for (int v = 0; v < static_cast<int>(cloth.cloth.size()); ++v) {
        if (cloth.cloth[v] < 0) continue;
        NearCloths::Cloth& owner = cloths[place_in(numbers, cloth.cloth[v])];
        owner.vertices.push_back(v);
        owner.thickness = std::max(owner.thickness, thickness[v]);
    }
    return NearCloths(std::move(cloths));
}

}  // namespace

SelfContactLists::SelfContactLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                                   const SelfContact& cloth)
    : thickness_(vertex_thickness.begin(), vertex_thickness.end()),
      cloth_(cloth.cloth.begin(), cloth.cloth.end()),
      cloth_pairs_(cloth.pairs),
      rest_(cloth.rest.begin(), cloth.rest.end()),
      surface_(make_cloth_surface(triangles, vertex_thickness.size())),
      skin_(skins(surface_, rest_, vertex_thickness)),
      sewn_(surface_, cloth.stitches, rest_,
            std::max(largest(vertex_thickness), largest_said(cloth.pairs)) / tolerances::contact_of_seam),
      near_cloths_(near_cloths(cloth, vertex_thickness)),
      clusters_of_cloth_(near_cloths_.count()),
      memory_{.start = rest_, .displacement = std::vector<Vec3>(rest_.size(), Vec3::Zero()), .seen = rest_, .groups = {}} {
    // Cloth by cloth, so that sheets that lie on each other do not share clusters.
    const std::vector<int> numbers = meeting_cloths(cloth_);
    std::vector<std::vector<int>> triangles_of(numbers.size());
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
        const int owner = cloth_[triangles[t][0]];
        if (owner >= 0) triangles_of[place_in(numbers, owner)].push_back(t);
    }
    for (std::size_t c = 0; c < numbers.size(); ++c) {
        const int first = static_cast<int>(clusters_.size());
        add_clusters(numbers[c], triangles_of[c], cloth.rest);
        clusters_of_cloth_[c].resize(clusters_.size() - static_cast<std::size_t>(first));
        std::iota(clusters_of_cloth_[c].begin(), clusters_of_cloth_[c].end(), first);
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
        for (const int v : made.all_vertices) {
            cluster.thickness = std::max(cluster.thickness, thickness_[v]);
            cluster.skin = std::max(cluster.skin, skin_[v]);
        }
        for (const auto& [a, b] : made.edges) cluster.shortest = std::min(cluster.shortest, (rest[a] - rest[b]).norm());
    }
}

double SelfContactLists::cover(std::span<const Vec3> from, std::span<const Vec3> to) {
    if (!memory_.groups.empty()) {
        set_motion(memory_.seen, from);
        for_each([&](SelfList& list, std::span<SelfPair>) { list.travel += shrink(list); });
    }
    std::copy(from.begin(), from.end(), memory_.seen.begin());
    const std::vector<int> stale = take_stale(from, to);
    if (stale.empty()) return 1.0;
    double fraction = 1.0;
    std::span<const Vec3> end = to;
    while (!rebuild(stale, from, end, fraction < tolerances::least_covered)) {
        fraction *= 0.5;
        shortened_.resize(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) shortened_[i] = from[i] + fraction * (to[i] - from[i]);
        end = shortened_;
    }
    keep_fresh();
    return fraction;
}

/// Takes out groups whose lists do not hold for a move. Returns their cloths, ascending: those of all groups that meet, too.
std::vector<int> SelfContactLists::take_stale(std::span<const Vec3> from, std::span<const Vec3> to) {
    std::vector<int> stale;
    old_pairs_.clear();
    if (memory_.groups.empty()) {
        stale.resize(cloth_count());
        std::iota(stale.begin(), stale.end(), 0);
        return stale;
    }
    std::vector<char>& meets = group_meets_;
    meets.assign(memory_.groups.size(), 0);
    if (memory_.groups.size() > 1) {
        group_of_cloth_.resize(cloth_count());
        for (std::size_t g = 0; g < memory_.groups.size(); ++g) {
            for (const int cloth : memory_.groups[g].cloths) group_of_cloth_[cloth] = static_cast<int>(g);
        }
        near_cloths_.set_motion(from, to);
        for (const auto& [a, b] : near_cloths_.meeting()) {
            const int first = group_of_cloth_[a], second = group_of_cloth_[b];
            if (first != second) meets[first] = meets[second] = 1;
        }
    }
    std::size_t kept = 0;
    for (std::size_t g = 0; g < memory_.groups.size(); ++g) {
        SelfGroup& group = memory_.groups[g];
        if (!meets[g] && covers(group, from) && covers(group, to)) {
            if (kept != g) std::swap(memory_.groups[kept], group);
            ++kept;
            continue;
        }
        stale.insert(stale.end(), group.cloths.begin(), group.cloths.end());
        std::copy_if(group.pairs.begin(), group.pairs.end(), std::back_inserter(old_pairs_),
                     [](const SelfPair& pair) { return pair.zone > 0.0; });
    }
    std::move(memory_.groups.begin() + static_cast<long>(kept), memory_.groups.end(), std::back_inserter(spare_));
    memory_.groups.resize(kept);
    std::sort(stale.begin(), stale.end());
    return stale;
}

Vec3 SelfContactLists::mean_motion(const SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to) const {
    Vec3 mean = Vec3::Zero();
    std::size_t vertices = 0;
    for_each_vertex(group, [&](int v) { mean += to[v] - from[v], ++vertices; });
    return mean / static_cast<double>(vertices);
}

/// Whether a state is start + s displacement + t + e; s and t by least squares.
bool SelfContactLists::covers(const SelfGroup& group, std::span<const Vec3> positions) const {
    const Vec3 mean = mean_motion(group, memory_.start, positions);
    double along = 0.0, length = 0.0;
    for_each_vertex(group, [&](int v) {
        along += memory_.displacement[v].dot(positions[v] - memory_.start[v] - mean);
        length += memory_.displacement[v].squaredNorm();
    });
    const double s = length > 0.0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
    const auto holds = [&](int v) {
        return (positions[v] - memory_.start[v] - mean - s * memory_.displacement[v]).squaredNorm() <= skin_[v] * skin_[v];
    };
    return std::all_of(group.cloths.begin(), group.cloths.end(), [&](int cloth) {
        return std::all_of(near_cloths_.vertices(cloth).begin(), near_cloths_.vertices(cloth).end(), holds);
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

/// Boxes of all features of a group during the move, as seen from its mean motion.
void SelfContactLists::set_boxes(const SelfGroup& group) {
    for_each_vertex(group, [&](int v) {
        vertex_boxes_[v] = Box{};
        vertex_boxes_[v].add(memory_.start[v]);
        vertex_boxes_[v].add(memory_.start[v] + memory_.displacement[v]);
    });
    const auto box_of = [&](const auto& vertices) {
        Box box;
        for (const int v : vertices) box.add(vertex_boxes_[v]);
        return box;
    };
    tree_clusters_.clear();
    tree_boxes_.clear();
    for (const int cloth : group.cloths) {
        for (const int c : clusters_of_cloth_[cloth]) {
            for (const int e : clusters_[c].edges) edge_boxes_[e] = box_of(surface_.edges[e].vertex);
            for (const int t : clusters_[c].triangles) triangle_boxes_[t] = box_of(surface_.triangles[t]);
            cluster_boxes_[c] = box_of(clusters_[c].all_vertices);
            cluster_boxes_[c].grow(clusters_[c].reach());
            tree_clusters_.push_back(c);
            tree_boxes_.push_back(cluster_boxes_[c]);
        }
    }
}

/// Makes groups and lists of some cloths anew; false (and lists of no use) if that takes too many pairs, unless
/// `whatever_it_takes`.
bool SelfContactLists::rebuild(std::span<const int> cloths, std::span<const Vec3> from, std::span<const Vec3> to,
                               bool whatever_it_takes) {
    const long most = whatever_it_takes ? std::numeric_limits<long>::max()
                                        : tolerances::most_self_pairs +
                                              tolerances::most_self_pairs_per_vertex * static_cast<long>(rest_.size());
    considered_ = 0;
    std::move(fresh_.begin(), fresh_.end(), std::back_inserter(spare_));
    fresh_.clear();
    set_motion(from, to);
    near_cloths_.set_motion(from, to);
    for (const std::vector<int>& near : near_cloths_.groups(cloths)) {
        if (spare_.empty()) spare_.emplace_back();
        SelfGroup& group = fresh_.emplace_back(std::move(spare_.back()));
        spare_.pop_back();
        group.cloths = near;
        if (!fill(group, from, to, most)) return false;
    }
    return true;
}

/// Makes the lists of a group; false once more than `most` pairs were looked at.
bool SelfContactLists::fill(SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to, long most) {
    filled_ = &group;
    group.lists.clear();
    group.pairs.clear();
    const Vec3 mean = mean_motion(group, from, to);
    for_each_vertex(group, [&](int v) {
        memory_.start[v] = from[v];
        memory_.displacement[v] = to[v] - from[v] - mean;
    });
    set_boxes(group);
    tree_.refit(tree_boxes_);
    tree_.find_pairs(cluster_pairs_);
    for (const auto& [first, second] : cluster_pairs_) {
        const int a = tree_clusters_[first], b = tree_clusters_[second];
        pair_ = cloth_pairs_.of(clusters_[a].cloth, clusters_[b].cloth);
        if (!pair_.contact) continue;
        SelfList list{.first = a, .second = b, .begin = group.pairs.size()};
        fill_list(list, from);
        if (list.end > list.begin) group.lists.push_back(list);
        if (considered_ > most) return false;
    }
    return true;
}

/// The groups just made are those of their cloths.
void SelfContactLists::keep_fresh() {
    std::sort(old_pairs_.begin(), old_pairs_.end(), comes_before);
    for (SelfGroup& group : fresh_) take_over_zones(group);
    std::move(fresh_.begin(), fresh_.end(), std::back_inserter(memory_.groups));
    fresh_.clear();
    std::sort(memory_.groups.begin(), memory_.groups.end(),
              [](const SelfGroup& a, const SelfGroup& b) { return a.cloths.front() < b.cloths.front(); });
}

void SelfContactLists::fill_list(SelfList& list, std::span<const Vec3> from) {
    const Cluster &a = clusters_[list.first], &b = clusters_[list.second];
    const bool is_fine = tolerances::contact_of_rest * std::min(a.shortest, b.shortest) < std::max(a.thickness, b.thickness);
    const Reach reach{.room = shrink(list) + a.skin + b.skin,
                      .limit = a.reach() + b.reach(),
                      .skins = a.skin + b.skin,
                      .rest_counts = is_fine && a.cloth == b.cloth};
    const bool one = list.first == list.second;
    find_near(a, cluster_boxes_[list.second], near_first_);
    find_near(b, cluster_boxes_[list.first], near_second_);
    pair_vertices(near_first_, near_second_, reach, from);
    if (!one) pair_vertices(near_second_, near_first_, reach, from);
    pair_edges(one, reach, from);
    list.end = filled_->pairs.size();
    list.smallest_reach = std::numeric_limits<double>::infinity();
    for (const SelfPair& pair : filled_->pairs_of(list)) {
        list.smallest_reach = std::min(list.smallest_reach, pair.reach);
        list.thickness = std::max(list.thickness, pair.thickness);
    }
}

/// Features of a cluster that come near the box of another, which is grown by that one's half of the limit.
void SelfContactLists::find_near(const Cluster& cluster, const Box& other, Near& near) const {
    Box reach = other;
    reach.grow(cluster.reach());
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
            if (reach.rest_counts &&
                vertex_boxes_[v].gap(triangle_boxes_[t]) >= thickness_by_rest(std::array{v}, face) + reach.skins) {
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
                edge_boxes_[e].gap(edge_boxes_[f]) >= thickness_by_rest(std::array{a, b}, std::array{c, d}) + reach.skins) {
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

/// What was a contact in the lists being replaced stays one.
void SelfContactLists::take_over_zones(SelfGroup& group) const {
    for (SelfPair& pair : group.pairs) {
        const auto found = std::lower_bound(old_pairs_.begin(), old_pairs_.end(), pair, comes_before);
        if (found == old_pairs_.end() || comes_before(pair, *found)) continue;
        pair.zone = found->zone;
        pair.began_apart = found->began_apart;
    }
}

}  // namespace percale
