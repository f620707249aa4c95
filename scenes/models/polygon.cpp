#include "models/polygon.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace percale::scenes {
namespace {

/// Relative to the square of the longest side: a triangle with less than this as twice its area has none. 0: ears along a line.
constexpr double min_turn = 1e-12;

/// Corners of a polygon that is cut into ears, which takes their square of time. More: seconds for one polygon.
constexpr std::size_t max_cut_corners = 10000;

/// Cuts corners off a polygon, the best shaped first.
class EarClipper {
public:
    explicit EarClipper(std::span<const Point2> outline) : x_(outline), quality_(outline.size()) {
        const int count = static_cast<int>(outline.size());
        for (int k = 0; k < count; ++k) {
            before_.push_back((k + count - 1) % count);
            after_.push_back((k + 1) % count);
        }
        left_ = count;
        judge_all();
    }

    std::optional<std::vector<Triangle>> clip() {
        std::vector<Triangle> ears;
        int any = 0;
        while (left_ > 3) {
            int best = find_best(any);
            if (best < 0) {
                judge_all();
                best = find_best(any);
            }
            if (best < 0) return std::nullopt;
            ears.push_back({before_[best], best, after_[best]});
            const int a = before_[best], b = after_[best];
            after_[a] = b;
            before_[b] = a;
            quality_[best] = -1.0;
            --left_;
            quality_[a] = judge(a);
            quality_[b] = judge(b);
            any = a;
        }
        if (turn(any) <= 0.0) return std::nullopt;
        ears.push_back({before_[any], any, after_[any]});
        return ears;
    }

private:
    double turn(int k) const { return turn_left(x_[before_[k]], x_[k], x_[after_[k]]); }

    int find_best(int any) const {
        int best = -1, k = any;
        for (int n = 0; n < left_; ++n, k = after_[k]) {
            if (quality_[k] > 0.0 && (best < 0 || quality_[k] > quality_[best])) best = k;
        }
        return best;
    }

    void judge_all() {
        int k = 0;
        while (quality_[k] < 0.0) ++k;
        for (int n = 0; n < left_; ++n, k = after_[k]) quality_[k] = judge(k);
    }

    /// The smallest angle of the ear at a corner; 0 where it is none.
    double judge(int k) const {
        const Point2 &a = x_[before_[k]], &b = x_[k], &c = x_[after_[k]];
        const double none = min_turn_of(a, b, c);
        if (turn(k) <= none) return 0.0;
        // Points on a side count as inside, also where they are rounded off it: else what is left may lie on one line.
        for (int other = after_[after_[k]]; other != before_[k]; other = after_[other]) {
            const Point2& p = x_[other];
            if (turn_left(a, b, p) >= -none && turn_left(b, c, p) >= -none && turn_left(c, a, p) >= -none) return 0.0;
        }
        return smallest_angle_of(a, b, c);
    }

    std::span<const Point2> x_;
    std::vector<int> before_, after_;
    std::vector<double> quality_;  // of the corners that are left; -1: cut off
    int left_ = 0;
};

/// A polygon seen along its normal, counter-clockwise; empty where it has none.
std::vector<Point2> seen_along_normal(std::span<const Vec3> corners) {
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k) {
        normal += (corners[k] - corners[0]).cross(corners[(k + 1) % corners.size()] - corners[0]);
    }
    if (!(normal.norm() > 0.0)) return {};
    const Vec3 across = normal.unitOrthogonal(), up = normal.normalized().cross(across);
    std::vector<Point2> seen;
    for (const Vec3& x : corners) seen.emplace_back(across.dot(x - corners[0]), up.dot(x - corners[0]));
    return seen;
}

std::vector<Triangle> fan(int count) {
    std::vector<Triangle> triangles;
    for (int k = 2; k < count; ++k) triangles.push_back({0, k - 1, k});
    return triangles;
}

/// Whether every triangle of the fan has an area and is turned like the polygon.
bool is_fan(std::span<const Point2> polygon) {
    for (std::size_t k = 2; k < polygon.size(); ++k) {
        const Point2 &a = polygon[0], &b = polygon[k - 1], &c = polygon[k];
        if (turn_left(a, b, c) <= min_turn_of(a, b, c)) return false;
    }
    return true;
}

}  // namespace

double turn_left(const Point2& a, const Point2& b, const Point2& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double smallest_angle_of(const Point2& a, const Point2& b, const Point2& c) {
    const auto angle = [](const Point2& u, const Point2& v) {
        return std::atan2(std::abs(u.x() * v.y() - u.y() * v.x()), u.dot(v));
    };
    return std::min({angle(b - a, c - a), angle(c - b, a - b), angle(a - c, b - c)});
}

double min_turn_of(const Point2& a, const Point2& b, const Point2& c) {
    return min_turn * std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
}

std::optional<std::vector<Triangle>> cut_ears(std::span<const Point2> outline) { return EarClipper(outline).clip(); }

std::vector<Triangle> polygon_triangles(std::span<const Vec3> corners) {
    const int count = static_cast<int>(corners.size());
    if (count <= 3 || corners.size() > max_cut_corners) return fan(count);
    const std::vector<Point2> seen = seen_along_normal(corners);
    if (seen.empty() || is_fan(seen)) return fan(count);
    return cut_ears(seen).value_or(fan(count));
}

std::vector<Triangle> triangles_of(const PolygonList& polygons, std::span<const Vec3> vertices) {
    std::vector<Triangle> triangles;
    triangles.reserve(polygons.corner_count() - 2 * polygons.size());
    std::vector<Vec3> places;
    for (std::size_t k = 0; k < polygons.size(); ++k) {
        const std::span<const int> corners = polygons.polygon(k);
        places.clear();
        for (const int corner : corners) places.push_back(vertices[static_cast<std::size_t>(corner)]);
        for (const Triangle& t : polygon_triangles(places)) triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    }
    return triangles;
}

bool are_same_polygons(std::span<const Triangle> some, std::span<const Triangle> others) {
    if (some.size() != others.size()) return false;
    // Sides and vertices of the triangles since the end of the last polygon. Sides of one list count up, those of the other down,
    // and opposite sides cancel. Where no side is left, both lists have the same outline; n triangles with n + 2 vertices are a
    // polygon.
    std::map<std::array<int, 2>, int> sides;
    std::set<int> vertices;
    std::size_t count = 0;
    const auto add = [&](const Triangle& t, int by) {
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            const auto side = sides.try_emplace({std::min(a, b), std::max(a, b)}).first;
            side->second += a < b ? by : -by;
            if (side->second == 0) sides.erase(side);
            vertices.insert(a);
        }
    };
    for (std::size_t k = 0; k < some.size(); ++k) {
        if (count == 0 && some[k] == others[k]) continue;
        add(some[k], 1);
        add(others[k], -1);
        ++count;
        if (!sides.empty()) continue;
        if (vertices.size() != count + 2) return false;
        vertices.clear();
        count = 0;
    }
    return count == 0;
}

}  // namespace percale::scenes
