#include "lists/candidate_lists.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

#include "lists/pack_measure.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Fraction of h, and of the displacement that a list is made for. Margin around a vertex within which its list is valid. Larger:
/// longer lists, which are rebuilt less often. Cost alone.
constexpr double box_skin = 0.4, box_skin_of_displacement = 0.2;

/// Fraction of h. A pack is left out of a list if a plane keeps it farther away than h by this much. Below rounding (1e-15)
/// contacts at h are missed.
constexpr double hull_slack = 1e-6;

/// Maximum number of packs in the lists, in all and for each vertex. A move that needs more is covered in part. Larger: more
/// memory at once (12 bytes a pack). Smaller: a long move takes more calls.
constexpr long max_packs = 500000, max_packs_per_vertex = 40;

/// Vertices and clusters in a chunk of a pass over all of them, and clusters in a chunk of lists to rebuild. Cost alone. More:
/// threads wait for the last chunk. Fewer: chunks cost more to hand out than to do.
constexpr unsigned vertices_a_part = 1024, clusters_a_pass = 128, clusters_a_build = 4;

double skin(double thickness, double displacement) { return box_skin * thickness + box_skin_of_displacement * displacement; }

/// How far a point inside a box is from its sides; negative outside.
double depth(const Box& box, const Vec3& x) { return std::min((x - box.low).minCoeff(), (box.high - x).minCoeff()); }

/// Whether the plane keeps the pack out of the thickness of vertices that stay in their boxes.
bool stays_above(const PackHull& hull, std::span<const int> vertices, const std::vector<Box>& boxes, double thickness) {
    const double enough = hull.offset + (1.0 + hull_slack) * thickness;
    return std::all_of(vertices.begin(), vertices.end(), [&](int vertex) {
        const Box& box = boxes[vertex];
        const Vec3 twice_centre = box.low + box.high, sides = box.high - box.low;
        return 0.5 * (hull.normal.dot(twice_centre) - hull.normal.cwiseAbs().dot(sides)) > enough;
    });
}

/// Sets the centre of the box of all means, and the bound of the deviations from it.
void set_drift(ClusterList& list, std::span<const PatchMotion> motions) {
    list.drift = Vec3::Zero();
    list.spread = 0.0;
    if (motions.empty()) return;
    Box means;
    for (const PatchMotion& motion : motions) means.add(motion.mean);
    list.drift = 0.5 * (means.low + means.high);
    for (const PatchMotion& motion : motions)
        list.spread = std::max(list.spread, (motion.mean - list.drift).norm() + motion.spread);
}

}  // namespace

void ListedPacks::clear() {
    reach.clear();
    wake.clear();
    at.clear();
}

void ListedPacks::add(int cloth_feature, int number, double apart, double thickness) {
    reach.push_back(below(apart));
    wake.push_back(below(apart - thickness));
    at.push_back({.feature = cloth_feature, .number = static_cast<unsigned>(number)});
}

void ListedPacks::make_persistent(std::size_t i, unsigned lane, double thickness) {
    at[i].persistent |= 1U << lane & 0xffU;
    wake[i] = below(static_cast<double>(reach[i]) - thickness);
}

int total_version(const Obstacles& obstacles) {
    int sum = static_cast<int>(obstacles.size());
    for (const auto& obstacle : obstacles) sum += obstacle->version();
    return sum;
}

CandidateLists::CandidateLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                               std::span<const Vec3> positions)
    : CandidateLists(triangles, vertex_thickness, make_clusters(triangles, positions),
                     {.lists = {}, .seen = {positions.begin(), positions.end()}, .anchor = {}}) {}

CandidateLists::CandidateLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                               ClothClusters clusters, CandidateListsState memory)
    : triangles_(triangles.begin(), triangles.end()),
      thickness_(vertex_thickness.begin(), vertex_thickness.end()),
      clusters_(std::move(clusters)),
      vertex_start_(1, 0),
      memory_(std::move(memory)),
      displacement_(thickness_.size(), 0.0),
      cluster_displacement_(clusters_.clusters.size(), 0.0),
      moved_(thickness_.size(), 0.0) {
    memory_.lists.resize(clusters_.clusters.size());
    for (std::size_t i = 0; i < memory_.lists.size(); ++i) {
        const std::vector<int>& all = clusters_.clusters[i].all_vertices;
        vertices_.insert(vertices_.end(), all.begin(), all.end());
        vertex_start_.push_back(static_cast<int>(vertices_.size()));
        ClusterList& list = memory_.lists[i];
        for (const int vertex : all) list.thickness = std::max(list.thickness, thickness_[vertex]);
    }
}

void CandidateLists::settle(const Obstacles& obstacles) {
    const int version = total_version(obstacles);
    const auto settled = [&](int& old) { old = old == good_version ? version : no_version; };
    for (ClusterList& list : memory_.lists) settled(list.version);
    settled(memory_.room_version);
}

void CandidateLists::forget_persistent(std::span<const unsigned char> moved) {
    for (ClusterList& list : memory_.lists) {
        if (!list.has_persistent) continue;
        list.has_persistent = false;
        for (ListedPack& pack : list.packs.at) {
            if (pack.persistent == 0) continue;
            const std::span<const int> cloth = list.features[pack.feature].vertices();
            if (std::any_of(cloth.begin(), cloth.end(), [&](int vertex) { return moved[vertex]; })) pack.persistent = 0;
            list.has_persistent = list.has_persistent || pack.persistent != 0;
        }
    }
}

bool CandidateLists::covers(std::size_t cluster, const ClothMove& move, int version) {
    ClusterList& list = memory_.lists[cluster];
    if (list.version != version) return false;
    const std::span<const int> vertices = vertices_of(cluster);
    if (list.cloth_travel + cluster_displacement_[cluster] <= list.inside_until) return true;
    double room = list.thickness, room_at_end = room;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        room = std::min(room, depth(list.boxes[k], move.from[vertices[k]]));
        room_at_end = std::min(room_at_end, depth(list.boxes[k], move.to[vertices[k]]));
    }
    list.inside_until = list.cloth_travel + room;
    return std::min(room, room_at_end) >= 0.0;
}

Box CandidateLists::set_boxes(std::size_t cluster, const ClothMove& move) {
    ClusterList& list = memory_.lists[cluster];
    list.boxes.clear();
    Box whole;
    for (const int vertex : vertices_of(cluster)) {
        Box& box = list.boxes.emplace_back();
        box.add(move.from[vertex]);
        box.add(move.to[vertex]);
        box.grow(skin(list.thickness, displacement_[vertex]));
        whole.add(box);
    }
    whole.grow(list.thickness);
    list.inside_until = -1.0;
    return whole;
}

/// Lists a cloth feature with those packs of its kind in near patches that can come within the thickness.
void CandidateLists::add_packs(const ContactPair& pair, const ClothMove& move, Obstacle& obstacle, ClusterList& list,
                               Build& build) {
    const std::span<const int> vertices = pair.vertices();
    Box room, now;
    for (const int vertex : vertices) {
        room.add(build.vertex_boxes[vertex]);
        now.add(move.from[vertex]);
    }
    room.grow(list.thickness);
    const ObstaclePacks& packs = obstacle.packs();
    const int feature = static_cast<int>(list.features.size());
    const std::size_t before = list.packs.size();
    for (const int patch : build.patches) {
        if (!packs.box[patch].overlaps(room)) continue;
        obstacle.ready(patch);
        const std::size_t so_far = list.packs.size();
        const auto [first, last] = packs.packs_of(patch, pair.kind);
        for (int number = first; number < last; ++number) {
            const PackHull& hull = packs.hulls[number];
            const Box box = hull.box();
            if (!box.overlaps(room) || stays_above(hull, vertices, build.vertex_boxes, list.thickness)) continue;
            const double apart = std::max(box.gap(now), height_above(hull, vertices, move.from));
            list.packs.add(feature, number, apart, list.thickness);
        }
        if (obstacle.moves() && list.packs.size() > so_far) build.motions.push_back(obstacle.motion_of(patch));
    }
    if (list.packs.size() == before) return;
    list.features.push_back(pair);
    build.listed += static_cast<long>(list.packs.size() - before);
}

void CandidateLists::add_features(std::size_t cluster, int obstacle_number, const ClothMove& move, Obstacle& obstacle,
                                  Build& build) {
    ClusterList& list = memory_.lists[cluster];
    const ClothCluster& features = clusters_.clusters[cluster];
    for (const int vertex : features.vertices) {
        add_packs({.kind = PairKind::vertex_face, .cloth = {vertex, -1, -1}, .obstacle = obstacle_number}, move, obstacle, list,
                  build);
    }
    for (const auto& [a, b] : features.edges) {
        add_packs({.kind = PairKind::edge_edge, .cloth = {a, b, -1}, .obstacle = obstacle_number}, move, obstacle, list, build);
    }
    for (const int face : features.triangles) {
        add_packs({.kind = PairKind::face_vertex,
                   .cloth = triangles_[face],
                   .edge_bits = clusters_.edge_owner_bits[face],
                   .across = clusters_.across[face],
                   .obstacle = obstacle_number},
                  move, obstacle, list, build);
    }
}

void CandidateLists::set_displacements(const ClothMove& move, Workers* workers) {
    const bool stays = move.from.data() == move.to.data();
    if (stays && !displaced_) return;
    displaced_ = !stays;
    const auto of_vertices = [&](std::size_t first, std::size_t last, int) {
        for (std::size_t i = first; i < last; ++i) displacement_[i] = (move.to[i] - move.from[i]).norm();
    };
    const auto of_clusters = [&](std::size_t first, std::size_t last, int) {
        for (std::size_t i = first; i < last; ++i) {
            double max = 0.0;
            for (const int vertex : vertices_of(i)) max = std::max(max, displacement_[vertex]);
            cluster_displacement_[i] = max;
        }
    };
    parallel_for_chunks(workers, displacement_.size(), vertices_a_part, of_vertices);
    parallel_for_chunks(workers, memory_.lists.size(), clusters_a_pass, of_clusters);
}

/// Whether all cloth stays away from all obstacles' boxes. The distance is measured once and permits displacements up to it, so
/// that cloth far away costs one pass over its vertices.
bool CandidateLists::is_far_from_obstacles(const ClothMove& move, const Obstacles& obstacles, int version) {
    const auto stays = [&] {
        const auto count = 3 * static_cast<long>(memory_.anchor.size());
        const auto displacement = [&](std::span<const Vec3> x) {
            return std::sqrt(3.0) * pack_kernels().largest_difference(x[0].data(), memory_.anchor[0].data(), count);
        };
        return displacement(move.from) < memory_.room &&
               (move.to.data() == move.from.data() || displacement(move.to) < memory_.room);
    };
    if (displacement_.empty()) return true;
    if (!memory_.empty) return false;
    if (memory_.room_version == version && memory_.room > 0.0 && stays()) return true;
    if (move.to.data() == move.from.data()) return false;
    Box cloth;
    for (const Vec3& x : move.from) cloth.add(x);
    memory_.room = 1e300;
    for (const auto& obstacle : obstacles) memory_.room = std::min(memory_.room, cloth.gap(obstacle->whole_box()));
    memory_.room -= *std::max_element(thickness_.begin(), thickness_.end());
    memory_.room_version = version;
    memory_.anchor.assign(move.from.begin(), move.from.end());
    return memory_.room > 0.0 && stays();
}

double CandidateLists::cover(const ClothMove& move, const Obstacles& obstacles, Workers* workers) {
    const int version = total_version(obstacles);
    if (is_far_from_obstacles(move, obstacles, version)) return 1.0;
    advance(move.from, move.fraction.from, obstacles, workers);
    set_displacements(move, workers);
    find_dirty(move, version, workers);
    if (dirty_.empty()) return 1.0;
    persistent_pairs_.clear();
    for (const std::size_t i : dirty_) collect_persistent(i, obstacles);
    double fraction = 1.0;
    ClothMove covered = move;
    while (!rebuild(covered, obstacles, fraction < tolerances::min_covered_fraction, workers)) {
        fraction *= 0.5;
        shortened_.resize(move.from.size());
        for (std::size_t i = 0; i < shortened_.size(); ++i) shortened_[i] = move.from[i] + fraction * (move.to[i] - move.from[i]);
        covered.to = shortened_;
        set_displacements(covered, workers);
    }
    if (fraction < 1.0) set_displacements(move, workers);
    restore_persistent(obstacles);
    memory_.empty =
        std::all_of(memory_.lists.begin(), memory_.lists.end(), [](const ClusterList& list) { return list.features.empty(); });
    return fraction;
}

/// Finds the clusters whose lists are not valid for the move; from now on they count as lists of this version.
void CandidateLists::find_dirty(const ClothMove& move, int version, Workers* workers) {
    uncovered_.resize(memory_.lists.size());
    parallel_for_chunks(workers, uncovered_.size(), clusters_a_pass, [&](std::size_t first, std::size_t last, int) {
        for (std::size_t i = first; i < last; ++i) uncovered_[i] = covers(i, move, version) ? 0 : 1;
    });
    dirty_.clear();
    for (std::size_t i = 0; i < uncovered_.size(); ++i) {
        if (uncovered_[i] == 0) continue;
        dirty_.push_back(i);
        memory_.lists[i].version = version;
    }
}

void CandidateLists::empty_dirty(const ClothMove& move) {
    query_boxes_.clear();
    for (const std::size_t i : dirty_) {
        ClusterList& list = memory_.lists[i];
        list.features.clear();
        list.packs.clear();
        list.has_persistent = false;
        list.travel = list.cloth_travel = 0.0;
        query_boxes_.push_back(set_boxes(i, move));
    }
}

void CandidateLists::set_smallest_bounds(ClusterList& list) {
    const ListedPacks& packs = list.packs;
    const auto count = static_cast<long>(packs.size());
    list.smallest_reach = static_cast<double>(pack_kernels().smallest(packs.reach.data(), count));
    list.quiet_until = static_cast<double>(pack_kernels().smallest(packs.wake.data(), count));
}

/// Rebuilds the dirty lists; returns false, with unusable lists, if they would hold too many packs, unless `whatever_it_takes`.
bool CandidateLists::rebuild(const ClothMove& move, const Obstacles& obstacles, bool whatever_it_takes, Workers* workers) {
    const long max = whatever_it_takes ? std::numeric_limits<long>::max()
                                       : max_packs + max_packs_per_vertex * static_cast<long>(displacement_.size());
    empty_dirty(move);
    found_.resize(obstacles.size());
    for (std::size_t number = 0; number < obstacles.size(); ++number) obstacles[number]->find(query_boxes_, found_[number]);
    builds_.resize(workers ? workers->threads() : 1);
    // Whether there are too many does not depend on the thread or the order in which they are counted.
    std::atomic<long> listed = 0;
    parallel_for_chunks(workers, dirty_.size(), clusters_a_build, [&](std::size_t first, std::size_t last, int slot) {
        Build& build = builds_[slot];
        build.vertex_boxes.resize(displacement_.size());
        build.listed = 0;
        for (std::size_t k = first; k < last && listed + build.listed <= max; ++k) build_list(k, move, obstacles, build);
        listed += build.listed;
    });
    return listed <= max;
}

/// Builds the list of dirty_[dirty].
void CandidateLists::build_list(std::size_t dirty, const ClothMove& move, const Obstacles& obstacles, Build& build) {
    const std::size_t cluster = dirty_[dirty];
    ClusterList& list = memory_.lists[cluster];
    const std::vector<int>& vertices = clusters_.clusters[cluster].all_vertices;
    for (std::size_t k = 0; k < vertices.size(); ++k) build.vertex_boxes[vertices[k]] = list.boxes[k];
    build.motions.clear();
    bool some_stay = false;
    for (std::size_t number = 0; number < obstacles.size(); ++number) {
        const IdLists& found = found_[number];
        const int first = found.start[dirty], count = found.start[dirty + 1] - first;
        if (count == 0) continue;
        build.patches = std::span<const int>(found.ids).subspan(first, count);
        const std::size_t before = list.packs.size();
        add_features(cluster, static_cast<int>(number), move, *obstacles[number], build);
        some_stay = some_stay || (!obstacles[number]->moves() && list.packs.size() > before);
    }
    if (some_stay && !build.motions.empty()) build.motions.push_back({});
    set_drift(list, build.motions);
    set_smallest_bounds(list);
}

double CandidateLists::approach(std::size_t cluster, const ClothMove& move) const {
    const ClusterList& list = memory_.lists[cluster];
    const double part = move.fraction.to - move.fraction.from;
    if (list.drift == Vec3::Zero()) return cluster_displacement_[cluster] + part * list.spread;
    const Vec3 drift = part * list.drift;
    double square = 0.0;
    for (const int vertex : vertices_of(cluster))
        square = std::max(square, (move.to[vertex] - move.from[vertex] - drift).squaredNorm());
    return std::sqrt(square) + part * list.spread;
}

void CandidateLists::collect_persistent(std::size_t cluster, const Obstacles& obstacles) {
    const ClusterList& list = memory_.lists[cluster];
    if (!list.has_persistent) return;
    for (std::size_t i = 0; i < list.packs.size(); ++i) {
        if (list.packs.at[i].persistent == 0) continue;
        const ContactPair& feature = list.features[list.packs.at[i].feature];
        const FeaturePack& pack = obstacles[feature.obstacle]->packs().packs[list.packs.at[i].number];
        for (unsigned persistent = list.packs.at[i].persistent; persistent != 0; persistent &= persistent - 1) {
            persistent_pairs_.emplace_back(cluster, feature.with(pack, std::countr_zero(persistent)));
        }
    }
}

/// A contact of a list stays one in the list that replaces it.
void CandidateLists::restore_persistent(const Obstacles& obstacles) {
    for (const auto& [cluster, contact] : persistent_pairs_) {
        ClusterList& list = memory_.lists[cluster];
        const int place = obstacles[contact.obstacle]->packs().place_of[static_cast<int>(contact.kind)][contact.feature];
        for (std::size_t f = 0; f < list.features.size(); ++f) {
            const ContactPair& pair = list.features[f];
            if (pair.kind == contact.kind && pair.cloth == contact.cloth && pair.obstacle == contact.obstacle)
                make_persistent(list, f, place);
        }
    }
}

/// Makes the lane at a place of ObstaclePacks::place_of persistent, if the feature is listed with its pack.
void CandidateLists::make_persistent(ClusterList& list, std::size_t feature, int place) const {
    std::vector<ListedPack>& packs = list.packs.at;
    const auto first = std::partition_point(
        packs.begin(), packs.end(), [&](const ListedPack& pack) { return static_cast<std::size_t>(pack.feature) < feature; });
    for (std::size_t i = first - packs.begin(); i < packs.size() && static_cast<std::size_t>(packs[i].feature) == feature; ++i) {
        if (static_cast<int>(packs[i].number) != place / pack_lanes) continue;
        list.packs.make_persistent(i, place % pack_lanes, thickness_[list.features[feature].cloth[0]]);
        list.quiet_until = std::min(list.quiet_until, static_cast<double>(list.packs.wake[i]));
        list.has_persistent = true;
    }
}

void CandidateLists::advance(std::span<const Vec3> positions, double fraction, const Obstacles& obstacles, Workers* workers) {
    const bool obstacles_move = std::any_of(obstacles.begin(), obstacles.end(), [](const auto& o) { return o->moves(); });
    const double part = obstacles_move ? fraction - memory_.seen_fraction : 0.0;
    memory_.seen_fraction = fraction;
    if (part != 0.0) gone_.resize(moved_.size());
    constexpr std::size_t grain = vertices_a_part;
    max_moved_.assign(chunk_count(moved_.size(), grain), 0.0);
    parallel_for_chunks(workers, moved_.size(), grain, [&](std::size_t first, std::size_t last, int) {
        double max = 0.0;
        for (std::size_t i = first; i < last; ++i) {
            const Vec3 gone = positions[i] - memory_.seen[i];
            if (part != 0.0) gone_[i] = gone;
            moved_[i] = gone.squaredNorm();
            max = std::max(max, moved_[i]);
        }
        max_moved_[first / grain] = max;
        if (max > 0.0) std::copy(positions.begin() + first, positions.begin() + last, memory_.seen.begin() + first);
    });
    const bool moved = std::any_of(max_moved_.begin(), max_moved_.end(), [](double max) { return max > 0.0; });
    if (!moved && part == 0.0) return;
    parallel_for_chunks(workers, memory_.lists.size(), clusters_a_pass, [&](std::size_t first, std::size_t last, int) {
        for (std::size_t i = first; i < last; ++i) advance_list(i, part);
    });
}

/// A distance shrinks at most by the motion of the cloth relative to the drift of the obstacles, and by theirs relative to it.
void CandidateLists::advance_list(std::size_t cluster, double part) {
    ClusterList& list = memory_.lists[cluster];
    const bool drifts = part != 0.0 && list.drift != Vec3::Zero();
    const Vec3 drift = part * list.drift;
    double square = 0.0, beside = 0.0;
    for (const int vertex : vertices_of(cluster)) {
        square = std::max(square, moved_[vertex]);
        if (drifts) beside = std::max(beside, (gone_[vertex] - drift).squaredNorm());
    }
    list.cloth_travel += std::sqrt(square);
    list.travel += std::sqrt(drifts ? beside : square) + std::abs(part) * list.spread;
}

}  // namespace percale
