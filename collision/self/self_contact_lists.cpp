#include "self/self_contact_lists.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

#include "geometry/chunks.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Fraction of h, and of the mean length of a vertex's edges: the lower is its skin. Two clusters may move against each other by
/// it beyond a predicted move before their list is rebuilt; the first also bounds how far one may go before lists are searched
/// for. See box_skin. Cost alone.
constexpr double self_skin = 0.5, self_skin_of_edge = 0.125;

/// Times the room that a step's move takes. The next step rebuilds lists and boxes that long trial moves have left with more.
/// Small: they are rebuilt often. Large: they keep features that are far away. Cost alone.
constexpr double max_room_ratio = 4.0;

/// Maximum number of pairs of cloth with cloth that are considered for one move, in all and for each vertex; there may be one
/// list for each `pairs_per_list` of them. See max_packs.
constexpr long max_self_pairs = 4000000, max_self_pairs_per_vertex = 300, pairs_per_list = 16;

/// How many clusters a thread takes at once, and after how many lists the pairs considered are counted. More: threads wait for
/// the last one, and lists are made after the pairs are too many. Fewer: threads ask for work, and wait for each other, more
/// often.
constexpr std::size_t self_clusters_a_part = 64, self_lists_a_round = 1024;

double largest(std::span<const double> list) { return list.empty() ? 0.0 : *std::max_element(list.begin(), list.end()); }

/// m, largest thickness that is set for a pair of the cloth, or for any pair if no cloth is given; 0 where none is set.
double largest_said(const ClothPairs& pairs, std::optional<int> cloth = {}) {
    double thickness = 0.0;
    for (const auto& [cloths, pair] : pairs.said()) {
        if (!cloth || cloths[0] == *cloth || cloths[1] == *cloth) thickness = std::max(thickness, pair.thickness.value_or(0.0));
    }
    return thickness;
}

void set_displacements(SelfCluster& cluster, std::span<const Vec3> from, std::span<const Vec3> to) {
    cluster.mean = Vec3::Zero();
    for (const int v : cluster.all_vertices) cluster.mean += to[v] - from[v];
    cluster.mean /= static_cast<double>(cluster.all_vertices.size());
    double square = 0.0;
    for (const int v : cluster.all_vertices) square = std::max(square, (to[v] - from[v] - cluster.mean).squaredNorm());
    cluster.spread = std::sqrt(square);
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

/// m, of each vertex: how much nearer its clusters may come to others beyond the move for which their lists are made.
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
        skins[v] = self_skin * thickness[v];
        if (edges[v] > 0.0) skins[v] = std::min(skins[v], self_skin_of_edge * lengths[v] / edges[v]);
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
    : cloth_{.thickness = {vertex_thickness.begin(), vertex_thickness.end()},
             .cloth = {cloth.cloth.begin(), cloth.cloth.end()},
             .pairs = cloth.pairs,
             .rest = {cloth.rest.begin(), cloth.rest.end()},
             .surface = make_cloth_surface(triangles, vertex_thickness.size())},
      skin_(skins(cloth_.surface, cloth_.rest, vertex_thickness)),
      near_cloths_(near_cloths(cloth, vertex_thickness)),
      clusters_of_cloth_(near_cloths_.count()) {
    cloth_.sewn = SewnRest(cloth_.surface, cloth.stitches, cloth_.rest,
                           std::max(largest(vertex_thickness), largest_said(cloth.pairs)) / tolerances::seam_activation_ratio);
    cloth_.vertex_boxes.resize(cloth_.rest.size());
    cloth_.edge_boxes.resize(cloth_.surface.edges.size());
    cloth_.triangle_boxes.resize(cloth_.surface.triangles.size());
    // Cloth by cloth, so that sheets that lie on each other do not share clusters.
    const std::vector<int> numbers = meeting_cloths(cloth_.cloth);
    std::vector<std::vector<int>> triangles_of(numbers.size());
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
        const int owner = cloth_.cloth[triangles[t][0]];
        if (owner >= 0) triangles_of[place_in(numbers, owner)].push_back(t);
    }
    for (std::size_t c = 0; c < numbers.size(); ++c) {
        const int first = static_cast<int>(cloth_.clusters.size());
        add_clusters(numbers[c], triangles_of[c]);
        clusters_of_cloth_[c].resize(cloth_.clusters.size() - static_cast<std::size_t>(first));
        std::iota(clusters_of_cloth_[c].begin(), clusters_of_cloth_[c].end(), first);
    }
    memory_.start = memory_.seen = cloth_.rest;
    memory_.rooms.resize(cloth_.clusters.size());
    left_.resize(cloth_.clusters.size());
}

void SelfContactLists::add_clusters(int cloth, std::span<const int> triangles) {
    const double said = largest_said(cloth_.pairs, cloth);
    std::vector<Triangle> corners;
    for (const int t : triangles) corners.push_back(cloth_.surface.triangles[t]);
    for (const ClothCluster& made : make_clusters(corners, cloth_.rest).clusters) {
        SelfCluster& cluster = cloth_.clusters.emplace_back();
        cluster.cloth = cloth;
        cluster.thickness = said;
        cluster.vertices = made.vertices;
        cluster.all_vertices = made.all_vertices;
        for (const int t : made.triangles) cluster.triangles.push_back(triangles[t]);
        for (const auto& [a, b] : made.edges) {
            cluster.edges.push_back(cloth_.surface.edge_between(a, b));
            cluster.shortest = std::min(cluster.shortest, (cloth_.rest[a] - cloth_.rest[b]).norm());
        }
        for (const int v : made.all_vertices) {
            cluster.thickness = std::max(cluster.thickness, cloth_.thickness[v]);
            cluster.skin = std::max(cluster.skin, skin_[v]);
        }
    }
}

double SelfContactLists::cover(std::span<const Vec3> from, std::span<const Vec3> to) {
    if (!std::equal(from.begin(), from.end(), memory_.seen.begin())) {
        move_to(from);
        if (from.data() != to.data()) cover(from, from);  // no move that has been covered need have led here
    }
    rebuild_islands(from, to, false);
    return cover_move(from, to);
}

double SelfContactLists::begin_step(std::span<const Vec3> from, std::span<const Vec3> to) {
    move_to(from);
    set_motion(memory_.start, from);
    for_each([&](SelfList& list) { list.used_room += shrink(list); });
    std::copy(from.begin(), from.end(), memory_.start.begin());
    cloth_.forget_boxes();
    rebuild_islands(memory_.start, to, true);
    give_up_room(memory_.start, to);
    return cover_move(memory_.start, to);
}

/// Shrinks the bounds of all lists.
void SelfContactLists::move_to(std::span<const Vec3> now) {
    set_motion(memory_.seen, now);
    for_each([&](SelfList& list) { list.travel += shrink(list); });
    std::copy(now.begin(), now.end(), memory_.seen.begin());
}

/// The lists are valid at `from`. Makes them valid up to the returned fraction of the move to `to`; displacement from where
/// clusters were at the start of the step is largest at an end of the move.
double SelfContactLists::cover_move(std::span<const Vec3> from, std::span<const Vec3> to) {
    double fraction = 1.0;
    std::span<const Vec3> end = to;
    for (;;) {
        const long max = fraction < tolerances::min_covered_fraction
                             ? std::numeric_limits<long>::max()
                             : max_self_pairs + max_self_pairs_per_vertex * static_cast<long>(cloth_.rest.size());
        set_motion(memory_.start, end);
        const auto has_lists = [&](Island& island) { return !set_rooms(island, from, end) || find_lists(island, max); };
        if (std::all_of(memory_.islands.begin(), memory_.islands.end(), has_lists) && make_stale(from, max)) break;
        give_up_lists_just_made();
        fraction *= 0.5;
        shortened_.resize(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) shortened_[i] = from[i] + fraction * (to[i] - from[i]);
        end = shortened_;
    }
    loose_lists_.clear();
    return fraction;
}

/// Gives up lists that would take too many pairs; they are then made for a shorter move.
void SelfContactLists::give_up_lists_just_made() {
    for_each([](SelfList& list) {
        if (list.travel == 0.0) list.give_up();
    });
}

/// Gives up clusters' boxes and lists that have far more room than a move takes, because their contents are examined at each
/// call.
void SelfContactLists::give_up_room(std::span<const Vec3> from, std::span<const Vec3> to) {
    for (const Island& island : memory_.islands) {
        for_each_swept(island, from, to, [&](int c, const Box& swept) {
            const double margins = 2.0 * self_skin * cloth_.clusters[c].thickness;
            const Box& room = memory_.rooms[c];
            const Vec3 wanted = swept.high - swept.low + Vec3::Constant(margins);
            if ((room.high - room.low).sum() > max_room_ratio * wanted.sum()) memory_.rooms[c] = Box{};
        });
    }
    set_motion(from, to);
    for_each([&](SelfList& list) {
        const double wanted = shrink(list) + cloth_.clusters[list.first].skin + cloth_.clusters[list.second].skin;
        if (!list.pairs.empty() && list.room - list.used_room > max_room_ratio * wanted) list.give_up();
    });
}

/// Divides the cloths into islands again where some meet or part in the linear motion between two states. Islands that have
/// changed have to find their lists.
void SelfContactLists::rebuild_islands(std::span<const Vec3> from, std::span<const Vec3> to, bool may_part) {
    if (memory_.islands.size() == 1 && cloth_count() == 1) return;
    island_of_cloth_.assign(memory_.islands.empty() ? 0 : cloth_count(), 0);
    for (const Island& island : memory_.islands) {
        for (const int cloth : island.cloths) island_of_cloth_[cloth] = island.cloths.front();
    }
    near_cloths_.set_motion(from, to);
    const std::vector<int>& first_of = near_cloths_.islands(island_of_cloth_, may_part);
    if (first_of == island_of_cloth_) return;
    std::vector<Island> islands;
    std::vector<std::size_t> place(first_of.size());
    for (int cloth = 0; cloth < static_cast<int>(first_of.size()); ++cloth) {
        if (first_of[cloth] == cloth) islands.emplace_back();
        place[cloth] = first_of[cloth] == cloth ? islands.size() - 1 : place[first_of[cloth]];
        islands[place[cloth]].cloths.push_back(cloth);
    }
    for (Island& old : memory_.islands) {
        Island& now = islands[place[old.cloths.front()]];
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
    memory_.islands = std::move(islands);
}

/// Rebuilds lists without room for a move. Returns false, and some are not rebuilt, if that takes too many pairs.
bool SelfContactLists::make_stale(std::span<const Vec3> from, long max) {
    stale_.clear();
    for_each([&](SelfList& list) {
        if (list.used_room + shrink(list) <= list.room) return;
        cloth_.set_box(list.first, memory_.start);
        cloth_.set_box(list.second, memory_.start);
        const SelfCluster &a = cloth_.clusters[list.first], &b = cloth_.clusters[list.second];
        const double apart = a.box.gap(b.box) - 0.5 * (a.thickness + b.thickness);
        if (apart >= shrink(list) + a.skin + b.skin) return list.clear(apart);
        cloth_.set_feature_boxes(list.first, memory_.start);
        cloth_.set_feature_boxes(list.second, memory_.start);
        stale_.push_back(&list);
    });
    makers_.resize(workers_ ? static_cast<std::size_t>(workers_->threads()) : 1);
    const std::span<SelfList* const> stale = stale_;
    long considered = 0;
    // Lists are made in rounds: the pairs are counted after each, so that the count is the same for any number of threads.
    for (std::size_t first = 0; first < stale.size() && considered <= max; first += self_lists_a_round) {
        const auto round = stale.subspan(first, std::min(self_lists_a_round, stale.size() - first));
        considered_.assign(round.size(), 0);
        parallel_for_chunks(workers_, round.size(), tolerances::self_lists_a_part,
                            [&](std::size_t begin, std::size_t end, int slot) {
                                for (std::size_t i = begin; i < end; ++i)
                                    considered_[i] = makers_[slot].fill(cloth_, *round[i], memory_.start, from);
                            });
        considered = std::accumulate(considered_.begin(), considered_.end(), considered);
    }
    return considered <= max;
}

Vec3 SelfContactLists::centre(const Island& island, std::span<const Vec3> positions) const {
    Vec3 sum = Vec3::Zero();
    std::size_t count = 0;
    for (const int cloth : island.cloths) {
        for (const int v : near_cloths_.vertices(cloth)) sum += positions[v];
        count += near_cloths_.vertices(cloth).size();
    }
    return sum / static_cast<double>(count);
}

/// Calls `work(cluster, Box)` for each cluster of an island, on all threads: its box in the linear motion, relative to the centre
/// of the island.
template <typename Work>
void SelfContactLists::for_each_swept(const Island& island, std::span<const Vec3> from, std::span<const Vec3> to,
                                      const Work& work) {
    const Vec3 begin = centre(island, from), end = centre(island, to);
    for (const int cloth : island.cloths) {
        const std::span<const int> clusters = clusters_of_cloth_[cloth];
        parallel_for_chunks(workers_, clusters.size(), self_clusters_a_part, [&](std::size_t first, std::size_t last, int) {
            for (const int c : clusters.subspan(first, last - first)) {
                Box swept;
                for (const int v : cloth_.clusters[c].all_vertices) {
                    swept.add(from[v] - begin);
                    swept.add(to[v] - end);
                }
                work(c, swept);
            }
        });
    }
}

/// Gives clusters that leave their rooms new ones; returns whether there are any.
bool SelfContactLists::set_rooms(const Island& island, std::span<const Vec3> from, std::span<const Vec3> to) {
    std::fill(left_.begin(), left_.end(), 0);
    for_each_swept(island, from, to, [&](int c, const Box& swept) {
        Box& room = memory_.rooms[c];
        if (room.contains(swept.low) && room.contains(swept.high)) return;
        room = swept;
        room.grow(self_skin * cloth_.clusters[c].thickness);
        left_[c] = 1;
    });
    return std::find(left_.begin(), left_.end(), 1) != left_.end();
}

/// Finds a list for each two clusters whose rooms come within their thicknesses; returns false, and drops the rooms, where there
/// are too many.
bool SelfContactLists::find_lists(Island& island, long max) {
    tree_clusters_.clear();
    tree_boxes_.clear();
    for (const int cloth : island.cloths) {
        for (const int c : clusters_of_cloth_[cloth]) {
            tree_clusters_.push_back(c);
            tree_boxes_.push_back(memory_.rooms[c]);
            tree_boxes_.back().grow(0.5 * cloth_.clusters[c].thickness);
        }
    }
    tree_.refit(tree_boxes_);
    if (!tree_.find_pairs(cluster_pairs_, max / pairs_per_list)) {
        for (const int c : tree_clusters_) memory_.rooms[c] = Box{};
        return false;
    }
    next_lists_.clear();
    for (const auto& [first, second] : cluster_pairs_) {
        const int a = tree_clusters_[first], b = tree_clusters_[second];
        if (cloth_.pairs.of(cloth_.clusters[a].cloth, cloth_.clusters[b].cloth).contact)
            next_lists_.push_back(take_list(island, a, b));
    }
    std::swap(island.lists, next_lists_);
    next_lists_.clear();
    return true;
}

/// The list of two clusters, taken from where it exists; otherwise one without room.
SelfList SelfContactLists::take_list(Island& island, int first, int second) {
    const std::pair wanted(first, second);
    for (std::vector<SelfList>* lists : {&island.lists, &loose_lists_}) {
        const auto found = std::lower_bound(lists->begin(), lists->end(), wanted,
                                            [](const SelfList& list, const auto& key) { return clusters_of(list) < key; });
        if (found != lists->end() && clusters_of(*found) == wanted) return std::move(*found);
    }
    return {.first = first, .second = second};
}

void SelfContactLists::set_motion(std::span<const Vec3> from, std::span<const Vec3> to) {
    parallel_for_chunks(workers_, cloth_.clusters.size(), self_clusters_a_part, [&](std::size_t first, std::size_t last, int) {
        for (std::size_t c = first; c < last; ++c) set_displacements(cloth_.clusters[c], from, to);
    });
}

double SelfContactLists::shrink(const SelfList& list) const {
    return shrink_of(cloth_.clusters[list.first], cloth_.clusters[list.second]);
}

}  // namespace percale
