#include "candidate_lists.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace percale {
namespace {

constexpr double skin_share = 0.4;    // of the thickness: room around a vertex before its lists are built anew
constexpr double least_share = 1e-4;  // of a move: below it lists are built however many pairs they hold
constexpr double skin_of_way = 0.2;   // of the move the list is built for

double skin(double thickness, double way) { return skin_share * thickness + skin_of_way * way; }

int total_version(const Obstacles& obstacles) {
    int sum = static_cast<int>(obstacles.size());
    for (const auto& obstacle : obstacles) sum += obstacle->version();
    return sum;
}

bool same_features(const ContactPair& a, const ContactPair& b) {
    return a.kind == b.kind && a.cloth == b.cloth && a.obstacle == b.obstacle && a.feature == b.feature;
}

/// Adds those pairs of one cloth feature with the features of nearby triangles that are near enough.
class PairCollector {
public:
    PairCollector(const ClothMove& move, int obstacle_number, const Obstacle& obstacle, ClusterList& list)
        : move_(move), number_(obstacle_number), obstacle_(obstacle), list_(list) {}
    long considered() const { return considered_; }

    /// `room`: how far the feature can get from where it is.
    void consider(ContactPair pair, double room, double thickness) {
        ++considered_;
        pair.obstacle = number_;
        const double distance = pair_distance(pair, move_.from, obstacle_, move_.part.from);
        if (distance >= thickness + room + obstacle_.longest_way()) return;
        pair.reach = distance + list_.travel;
        list_.pairs.push_back(pair);
    }

private:
    const ClothMove& move_;
    int number_;
    const Obstacle& obstacle_;
    ClusterList& list_;
    long considered_ = 0;
};

}  // namespace

CandidateLists::CandidateLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                               std::span<const Vec3> positions)
    : triangles_(triangles.begin(), triangles.end()),
      thickness_(vertex_thickness.begin(), vertex_thickness.end()),
      clusters_(make_clusters(triangles, positions)),
      lists_(clusters_.clusters.size()),
      seen_(positions.begin(), positions.end()),
      room_(positions.size(), 0.0),
      vertex_boxes_(positions.size()) {
    for (std::size_t i = 0; i < lists_.size(); ++i) {
        for (const int vertex : clusters_.clusters[i].all_vertices) {
            lists_[i].thickness = std::max(lists_[i].thickness, thickness_[vertex]);
        }
    }
}

bool CandidateLists::covers(std::size_t cluster, const ClothMove& move, int version) const {
    const ClusterList& list = lists_[cluster];
    if (list.version != version) return false;
    const std::vector<int>& vertices = clusters_.clusters[cluster].all_vertices;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        if (!list.boxes[k].contains(move.from[vertices[k]]) || !list.boxes[k].contains(move.to[vertices[k]])) return false;
    }
    return true;
}

Box CandidateLists::set_boxes(std::size_t cluster, const ClothMove& move) {
    ClusterList& list = lists_[cluster];
    list.boxes.clear();
    Box all;
    for (const int vertex : clusters_.clusters[cluster].all_vertices) {
        const double way = (move.to[vertex] - move.from[vertex]).norm();
        Box& box = list.boxes.emplace_back();
        box.add(move.from[vertex]);
        box.add(move.to[vertex]);
        box.grow(skin(list.thickness, way));
        all.add(box);
    }
    all.grow(list.thickness);
    return all;
}

/// Scatters a cluster's boxes and rooms to its vertices, for pairing.
void CandidateLists::set_rooms(std::size_t cluster, const ClothMove& move) {
    const std::vector<int>& vertices = clusters_.clusters[cluster].all_vertices;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const int vertex = vertices[k];
        const double way = (move.to[vertex] - move.from[vertex]).norm();
        vertex_boxes_[vertex] = lists_[cluster].boxes[k];
        room_[vertex] = way + std::sqrt(3.0) * skin(lists_[cluster].thickness, way);
    }
}

/// Those of the triangles `near` whose boxes come within the thickness of a feature's.
std::span<const int> CandidateLists::close_to(std::span<const int> vertices, std::span<const int> near, double thickness,
                                              const Obstacle& obstacle) {
    Box box;
    for (const int vertex : vertices) box.add(vertex_boxes_[vertex]);
    box.grow(thickness);
    close_.clear();
    for (const int triangle : near) {
        if (obstacle.box(triangle).overlaps(box)) close_.push_back(triangle);
    }
    return close_;
}

void CandidateLists::add_pairs(std::size_t cluster, int obstacle_number, std::span<const int> near, const ClothMove& move,
                               const Obstacle& obstacle) {
    const ObstacleSurface& surface = obstacle.surface();
    const ClothCluster& features = clusters_.clusters[cluster];
    PairCollector collector(move, obstacle_number, obstacle, lists_[cluster]);
    const double thickness = lists_[cluster].thickness;
    for (const int vertex : features.vertices) {
        for (const int triangle : close_to({&vertex, 1}, near, thickness, obstacle)) {
            collector.consider({.kind = PairKind::vertex_face, .cloth = {vertex, -1, -1}, .feature = triangle}, room_[vertex],
                               thickness);
        }
    }
    for (const std::array<int, 2>& ends : features.edges) {
        const double room = std::max(room_[ends[0]], room_[ends[1]]);
        for (const int triangle : close_to(ends, near, thickness, obstacle)) {
            for (const int edge : surface.triangle_edges[triangle]) {
                if (surface.edges[edge].owner != triangle || !surface.edges[edge].can_touch) continue;
                collector.consider({.kind = PairKind::edge_edge, .cloth = {ends[0], ends[1], -1}, .feature = edge}, room,
                                   thickness);
            }
        }
    }
    for (const int face : features.triangles) {
        const Triangle& t = triangles_[face];
        const double room = std::max({room_[t[0]], room_[t[1]], room_[t[2]]});
        for (const int triangle : close_to(t, near, thickness, obstacle)) {
            for (const int vertex : surface.triangles[triangle]) {
                if (surface.vertex_owner[vertex] != triangle || !surface.vertex_can_touch[vertex]) continue;
                collector.consider(
                    {.kind = PairKind::face_vertex, .cloth = t, .edge_bits = clusters_.edge_owner_bits[face], .feature = vertex},
                    room, thickness);
            }
        }
    }
    considered_ += collector.considered();
}

double CandidateLists::cover(const ClothMove& move, const Obstacles& obstacles) {
    advance(move.from, move.part.from, obstacles);
    const int version = total_version(obstacles);
    dirty_.clear();
    held_.clear();
    for (std::size_t i = 0; i < lists_.size(); ++i) {
        if (covers(i, move, version)) continue;
        dirty_.push_back(i);
        for (const ContactPair& pair : lists_[i].pairs) {
            if (pair.held) held_.emplace_back(i, pair);
        }
        lists_[i].version = version;
    }
    if (dirty_.empty()) return 1.0;
    double share = 1.0;
    ClothMove covered = move;
    while (!rebuild(covered, obstacles, share < least_share)) {
        share *= 0.5;
        shortened_.resize(move.from.size());
        for (std::size_t i = 0; i < shortened_.size(); ++i) shortened_[i] = move.from[i] + share * (move.to[i] - move.from[i]);
        covered.to = shortened_;
    }
    mark_held();
    return share;
}

/// Builds the dirty lists anew; false (and lists of no use) if that takes too many pairs, unless `whatever_it_takes`.
bool CandidateLists::rebuild(const ClothMove& move, const Obstacles& obstacles, bool whatever_it_takes) {
    const long most = whatever_it_takes ? std::numeric_limits<long>::max() : 4000000L + 300L * static_cast<long>(room_.size());
    considered_ = 0;
    asked_.clear();
    for (const std::size_t i : dirty_) {
        lists_[i].pairs.clear();
        asked_.push_back(set_boxes(i, move));
    }
    for (std::size_t number = 0; number < obstacles.size(); ++number) {
        obstacles[number]->find(asked_, found_);
        for (std::size_t k = 0; k < dirty_.size(); ++k) {
            const auto near = std::span<const int>(found_.ids).subspan(found_.start[k], found_.start[k + 1] - found_.start[k]);
            if (near.empty()) continue;
            set_rooms(dirty_[k], move);
            add_pairs(dirty_[k], static_cast<int>(number), near, move, *obstacles[number]);
            if (considered_ > most) return false;
        }
    }
    for (const std::size_t i : dirty_) {
        lists_[i].least_reach = std::numeric_limits<double>::infinity();
        for (const ContactPair& pair : lists_[i].pairs) lists_[i].least_reach = std::min(lists_[i].least_reach, pair.reach);
    }
    return true;
}

/// What was a contact in a list stays one in the list that replaces it.
void CandidateLists::mark_held() {
    for (const auto& [cluster, held] : held_) {
        for (ContactPair& pair : lists_[cluster].pairs) pair.held = pair.held || same_features(pair, held);
    }
}

double CandidateLists::shrink_of(std::size_t cluster, std::span<const Vec3> positions) const {
    double square = 0.0;
    for (const int vertex : clusters_.clusters[cluster].all_vertices) {
        square = std::max(square, (positions[vertex] - seen_[vertex]).squaredNorm());
    }
    return std::sqrt(square);
}

void CandidateLists::advance(std::span<const Vec3> positions, double fraction, const Obstacles& obstacles) {
    double way = 0.0;
    for (const auto& obstacle : obstacles) way = std::max(way, obstacle->longest_way());
    way *= std::abs(fraction - seen_fraction_);
    for (std::size_t i = 0; i < lists_.size(); ++i) {
        if (!lists_[i].pairs.empty()) lists_[i].travel += shrink_of(i, positions) + way;
    }
    std::copy(positions.begin(), positions.end(), seen_.begin());
    seen_fraction_ = fraction;
}

}  // namespace percale
