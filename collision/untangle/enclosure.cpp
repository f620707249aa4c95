#include "untangle/enclosure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "tolerances.h"

namespace percale {
namespace {

/// Half of the solid angle of a triangle about a point (van Oosterom and Strackee, The solid angle of a plane triangle, 1983).
double half_solid_angle(const Vec3& point, const Vec3& first, const Vec3& second, const Vec3& third) {
    const Vec3 a = first - point, b = second - point, c = third - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la);
}

}  // namespace

Enclosure::Enclosure(std::vector<Triangle> triangles, std::span<const Vec3> positions, std::span<const Vec3> points)
    : triangles_(std::move(triangles)) {
    std::set<std::pair<int, int>> edges;
    for (const Triangle& t : triangles_) {
        for (int k = 0; k < 3; ++k) edges.emplace(t[k], t[(k + 1) % 3]);
    }
    std::map<int, int> lower;  // of vertices on rims, one of the same rim
    const auto lowest = [&](int vertex) {
        while (lower.at(vertex) != vertex) vertex = lower[vertex] = lower[lower[vertex]];
        return vertex;
    };
    for (const auto& [a, b] : edges) {
        if (edges.contains({b, a})) continue;
        lower.try_emplace(a, a);
        lower.try_emplace(b, b);
        lower[std::max(lowest(a), lowest(b))] = std::min(lowest(a), lowest(b));
        rims_.push_back({b, a, -1});
    }
    std::map<int, int> number;
    for (auto& [b, a, rim] : rims_) rim = number.try_emplace(lowest(a), static_cast<int>(number.size())).first->second;
    rim_count_ = static_cast<int>(number.size());
    if (rim_count_ < 2) return;
    const std::vector<Vec3> centres = middles(positions);
    for (const Vec3& point : points) {
        if (surrounds(point, positions, centres)) surrounded_.push_back(point);
    }
}

bool Enclosure::lost(std::span<const Vec3> positions) const {
    if (static_cast<int>(surrounded_.size()) < tolerances::least_surrounded) return false;
    const std::vector<Vec3> centres = middles(positions);
    const auto left = static_cast<std::size_t>(std::count_if(
        surrounded_.begin(), surrounded_.end(), [&](const Vec3& point) { return surrounds(point, positions, centres); }));
    return 2 * left < surrounded_.size();
}

bool Enclosure::surrounds(const Vec3& point, std::span<const Vec3> x, std::span<const Vec3> centres) const {
    double sum = 0.0;
    for (const auto& [a, b, c] : triangles_) sum += half_solid_angle(point, x[a], x[b], x[c]);
    for (const auto& [a, b, rim] : rims_) sum += half_solid_angle(point, x[a], x[b], centres[rim]);
    return std::abs(sum) > std::numbers::pi;
}

/// Of the rims, m.
std::vector<Vec3> Enclosure::middles(std::span<const Vec3> positions) const {
    std::vector<Vec3> sum(rim_count_, Vec3::Zero());
    std::vector<int> count(rim_count_, 0);
    for (const auto& [a, b, rim] : rims_) {
        sum[rim] += positions[a];
        ++count[rim];
    }
    for (int rim = 0; rim < rim_count_; ++rim) sum[rim] /= count[rim];
    return sum;
}

}  // namespace percale
