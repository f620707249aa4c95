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

Box box_of(std::span<const int> vertices, std::span<const Vec3> positions) {
    Box box;
    for (const int v : vertices) box.add(positions[v]);
    return box;
}

std::pair<int, int> clusters_of(const SelfList& list) { return {list.first, list.second}; }

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
      memory_{.seen = rest_, .rooms = {}, .groups = {}} {
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
    memory_.rooms.resize(clusters_.size());
    boxed_.resize(clusters_.size());
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
        for_each([&](SelfList& list) { list.travel += shrink(list); });
    }
    std::copy(from.begin(), from.end(), memory_.seen.begin());
    regroup(from, to);
    double fraction = 1.0;
    std::span<const Vec3> end = to;
    ++covers_;
    for (;;) {
        const long most =
            fraction < tolerances::least_covered
                ? std::numeric_limits<long>::max()
                : tolerances::most_self_pairs + tolerances::most_self_pairs_per_vertex * static_cast<long>(rest_.size());
        set_motion(from, end);
        considered_ = 0;
        const auto updated = [&](SelfGroup& group) { return update(group, from, end, most); };
        if (std::all_of(memory_.groups.begin(), memory_.groups.end(), updated)) break;
        fraction *= 0.5;
        shortened_.resize(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) shortened_[i] = from[i] + fraction * (to[i] - from[i]);
        end = shortened_;
    }
    loose_lists_.clear();
    return fraction;
}

/// Divides cloths into groups anew where some meet or part on the straight line between two states. Groups that have changed
/// have to find their lists.
void SelfContactLists::regroup(std::span<const Vec3> from, std::span<const Vec3> to) {
    if (memory_.groups.size() == 1 && cloth_count() == 1) return;
    group_of_cloth_.assign(memory_.groups.empty() ? 0 : cloth_count(), 0);
    for (const SelfGroup& group : memory_.groups) {
        for (const int cloth : group.cloths) group_of_cloth_[cloth] = group.cloths.front();
    }
    near_cloths_.set_motion(from, to);
    const std::vector<int> first_of = near_cloths_.groups(group_of_cloth_);
    if (first_of == group_of_cloth_) return;
    std::vector<SelfGroup> groups;
    std::vector<std::size_t> place(first_of.size());
    for (int cloth = 0; cloth < static_cast<int>(first_of.size()); ++cloth) {
        if (first_of[cloth] == cloth) groups.emplace_back();
        place[cloth] = first_of[cloth] == cloth ? groups.size() - 1 : place[first_of[cloth]];
        groups[place[cloth]].cloths.push_back(cloth);
    }
    for (SelfGroup& old : memory_.groups) {
        SelfGroup& now = groups[place[old.cloths.front()]];
        if (now.cloths == old.cloths) {
            now.lists = std::move(old.lists);
            continue;
        }
        std::move(old.lists.begin(), old.lists.end(), std::back_inserter(loose_lists_));
        for (const int cloth : old.cloths) {
            for (const int cluster : clusters_of_cloth_[cloth]) memory_.rooms[cluster] = Box{};
        }
    }
    std::sort(loose_lists_.begin(), loose_lists_.end(),
              [](const SelfList& a, const SelfList& b) { return clusters_of(a) < clusters_of(b); });
    memory_.groups = std::move(groups);
}

/// Makes lists of a group good for a move; false (and some of them not) if that takes too many pairs.
bool SelfContactLists::update(SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to, long most) {
    if (set_rooms(group, from, to)) find_lists(group);
    for (SelfList& list : group.lists) {
        if (list.travel + shrink(list) <= list.room) continue;
        fill(list, from);
        if (considered_ > most) return false;
    }
    return true;
}

Vec3 SelfContactLists::centre(const SelfGroup& group, std::span<const Vec3> positions) const {
    Vec3 sum = Vec3::Zero();
    std::size_t count = 0;
    for (const int cloth : group.cloths) {
        for (const int v : near_cloths_.vertices(cloth)) sum += positions[v];
        count += near_cloths_.vertices(cloth).size();
    }
    return sum / static_cast<double>(count);
}

/// Gives clusters that leave their rooms others; whether there are any.
bool SelfContactLists::set_rooms(const SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to) {
    const Vec3 first = centre(group, from), last = centre(group, to);
    bool any = false;
    for (const int cloth : group.cloths) {
        for (const int c : clusters_of_cloth_[cloth]) {
            Box swept;
            for (const int v : clusters_[c].all_vertices) {
                swept.add(from[v] - first);
                swept.add(to[v] - last);
            }
            Box& room = memory_.rooms[c];
            if (room.contains(swept.low) && room.contains(swept.high)) continue;
            room = swept;
            room.grow(tolerances::self_skin * clusters_[c].thickness);
            any = true;
        }
    }
    return any;
}

/// A list for each two clusters whose rooms come within their thicknesses.
void SelfContactLists::find_lists(SelfGroup& group) {
    tree_clusters_.clear();
    tree_boxes_.clear();
    for (const int cloth : group.cloths) {
        for (const int c : clusters_of_cloth_[cloth]) {
            tree_clusters_.push_back(c);
            tree_boxes_.push_back(memory_.rooms[c]);
            tree_boxes_.back().grow(0.5 * clusters_[c].thickness);
        }
    }
    tree_.refit(tree_boxes_);
    tree_.find_pairs(cluster_pairs_);
    next_lists_.clear();
    for (const auto& [first, second] : cluster_pairs_) {
        const int a = tree_clusters_[first], b = tree_clusters_[second];
        if (cloth_pairs_.of(clusters_[a].cloth, clusters_[b].cloth).contact) next_lists_.push_back(take_list(group, a, b));
    }
    std::swap(group.lists, next_lists_);
}

/// The list of two clusters, from where there is one; else one without room.
SelfList SelfContactLists::take_list(SelfGroup& group, int first, int second) {
    const std::pair wanted(first, second);
    for (std::vector<SelfList>* lists : {&group.lists, &loose_lists_}) {
        const auto found = std::lower_bound(lists->begin(), lists->end(), wanted,
                                            [](const SelfList& list, const auto& key) { return clusters_of(list) < key; });
        if (found != lists->end() && clusters_of(*found) == wanted) return std::move(*found);
    }
    return {.first = first, .second = second};
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
