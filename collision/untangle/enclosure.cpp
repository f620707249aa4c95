#include "untangle/enclosure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "certificate/box_tree.h"
#include "geometry/disjoint_sets.h"

namespace percale {
namespace {

/// Number of sample points along each axis of the box about cloth, by which it is found what the cloth surrounds. More:
/// untangling takes longer. Fewer: a skirt may leave the body that it was put on.
constexpr int enclosure_places = 8;

/// Fraction of the diagonal of that box by which it grows, so that no sample point is in the plane of flat cloth.
constexpr double enclosure_room = 0.01;

/// Cloth that surrounds at least this many sample points inside an obstacle must still surround it afterwards. Smaller: chance
/// decides.
constexpr int min_surrounded = 4;

/// Sample points from the middle of a rim to its vertices that test whether an obstacle passes through it. Fewer: legs are
/// missed.
constexpr double fan_places[] = {0.0, 0.25, 0.5, 0.75, 0.95};

/// Half of the solid angle of a triangle about a point (van Oosterom and Strackee, The solid angle of a plane triangle, 1983).
double half_solid_angle(const Vec3& point, const Vec3& first, const Vec3& second, const Vec3& third) {
    const Vec3 a = first - point, b = second - point, c = third - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la);
}

/// The places of a grid in a box that are inside the obstacle; none is in the plane of a flat box.
std::vector<Vec3> places_inside(certificate::Box box, const SolidObstacle& obstacle) {
    constexpr int count = enclosure_places;
    static_assert(count % 2 == 0);
    const Vec3 room = Vec3::Constant(enclosure_room * (box.high - box.low).norm());
    box.low -= room;
    box.high += room;
    std::vector<Vec3> places;
    for (int i = 0; i < count * count * count; ++i) {
        const Vec3 cell(i % count + 0.5, i / count % count + 0.5, i / (count * count) + 0.5);
        const Vec3 place = box.low + (box.high - box.low).cwiseProduct(cell / count);
        if (obstacle.inside(place)) places.push_back(place);
    }
    return places;
}

}  // namespace

Enclosure::Enclosure(std::vector<Triangle> triangles, std::span<const Vec3> positions, const SolidObstacle& obstacle)
    : triangles_(std::move(triangles)) {
    if (!obstacle.watertight()) return;
    find_rims(positions.size());
    if (rim_count_ < 2 || !passes_through(positions, obstacle)) return;
    certificate::Box box;
    for (const Triangle& t : triangles_) {
        for (const int v : t) box.add(positions[v]);
    }
    const std::vector<Vec3> centres = middles(positions);
    for (const Vec3& place : places_inside(box, obstacle)) {
        if (surrounds(place, positions, centres)) surrounded_.push_back(place);
    }
}

bool Enclosure::lost(std::span<const Vec3> positions) const {
    if (static_cast<int>(surrounded_.size()) < min_surrounded) return false;
    const std::vector<Vec3> centres = middles(positions);
    const auto left = static_cast<std::size_t>(std::count_if(
        surrounded_.begin(), surrounded_.end(), [&](const Vec3& place) { return surrounds(place, positions, centres); }));
    return 2 * left < surrounded_.size();
}

/// Finds the edges of only one triangle; those that are connected by vertices form a rim.
void Enclosure::find_rims(std::size_t vertex_count) {
    std::set<std::pair<int, int>> edges;
    for (const Triangle& t : triangles_) {
        for (int k = 0; k < 3; ++k) edges.emplace(t[k], t[(k + 1) % 3]);
    }
    DisjointSets rims(vertex_count);
    for (const auto& [a, b] : edges) {
        if (edges.contains({b, a})) continue;
        rims.join(a, b);
        rims_.push_back({b, a, -1});
    }
    std::map<int, int> number;
    for (RimEdge& edge : rims_) edge.rim = number.try_emplace(rims.of(edge.from), static_cast<int>(number.size())).first->second;
    rim_count_ = static_cast<int>(number.size());
}

/// Whether the fans of two rims or more go through the obstacle, and some of the cloth is outside.
bool Enclosure::passes_through(std::span<const Vec3> x, const SolidObstacle& obstacle) const {
    const auto outside = [&](const Triangle& t) { return !obstacle.inside(x[t[0]]); };
    if (std::none_of(triangles_.begin(), triangles_.end(), outside)) return false;
    const std::vector<Vec3> centres = middles(x);
    std::set<int> passed;
    for (const RimEdge& edge : rims_) {
        for (const double out : fan_places) {
            if (passed.contains(edge.rim)) break;
            if (obstacle.inside(centres[edge.rim] + out * (x[edge.from] - centres[edge.rim]))) passed.insert(edge.rim);
        }
    }
    return passed.size() >= 2;
}

bool Enclosure::surrounds(const Vec3& place, std::span<const Vec3> x, std::span<const Vec3> centres) const {
    double sum = 0.0;
    for (const auto& [a, b, c] : triangles_) sum += half_solid_angle(place, x[a], x[b], x[c]);
    for (const auto& [a, b, rim] : rims_) sum += half_solid_angle(place, x[a], x[b], centres[rim]);
    return std::abs(sum) > std::numbers::pi;
}

/// The middles of the rims, m.
std::vector<Vec3> Enclosure::middles(std::span<const Vec3> positions) const {
    std::vector<Vec3> sum(rim_count_, Vec3::Zero());
    std::vector<int> count(rim_count_, 0);
    for (const RimEdge& edge : rims_) {
        sum[edge.rim] += positions[edge.from];
        ++count[edge.rim];
    }
    for (int rim = 0; rim < rim_count_; ++rim) sum[rim] /= count[rim];
    return sum;
}

}  // namespace percale
