#include "self/sewn_rest.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "geometry/disjoint_sets.h"

namespace percale {
namespace {

constexpr double unreachable = std::numeric_limits<double>::infinity();

/// Shortest paths from one place, found in ascending order.
class SewnFront {
public:
    explicit SewnFront(double reach) : reach_(reach) {}

    void reach_vertex(int vertex, double length) {
        if (length <= reach_) start_at(vertex, length);
    }
    /// Starts there however long the path is.
    void start_at(int vertex, double length) {
        const auto [known, is_new] = length_.try_emplace(vertex, length);
        if (!is_new && known->second <= length) return;
        known->second = length;
        open_.emplace(length, vertex);
    }
    /// The nearest vertex whose neighbours are not reached yet, with its length; -1: there is none.
    std::pair<int, double> next() {
        while (!open_.empty()) {
            const auto [length, vertex] = open_.top();
            open_.pop();
            if (length_[vertex] == length) return {vertex, length};
        }
        return {-1, 0.0};
    }
    const std::map<int, double>& lengths() const { return length_; }

private:
    using Entry = std::pair<double, int>;

    double reach_;
    std::map<int, double> length_;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

bool holds(std::span<const int> feature, int vertex) {
    return std::find(feature.begin(), feature.end(), vertex) != feature.end();
}

}  // namespace

SewnRest::SewnRest(const ClothSurface& surface, std::span<const Stitch> stitches, std::span<const Vec3> rest, double reach)
    : knot_of_(rest.size(), -1), ends_(rest.size()), paths_(rest.size()) {
    make_knots(stitches);
    for (int knot = 0; knot < static_cast<int>(knots_.size()); ++knot) find_paths(knot, surface, rest, reach);
}

void SewnRest::make_knots(std::span<const Stitch> stitches) {
    DisjointSets sewn(knot_of_.size());
    for (const Stitch& stitch : stitches) {
        if (stitch.joins_vertices()) sewn.join(stitch.vertex, stitch.other());
    }
    const auto knot_at = [&](int vertex) {
        int& knot = knot_of_[sewn.of(vertex)];
        if (knot >= 0) return knot;
        knot = static_cast<int>(knots_.size());
        knots_.emplace_back();
        return knot;
    };
    for (const Stitch& stitch : stitches) {
        const int knot = knot_at(stitch.vertex);
        if (!stitch.joins_vertices()) knots_[knot].points.push_back(stitch);
    }
    find_ends(sewn);
    for (int vertex = 0; vertex < static_cast<int>(knot_of_.size()); ++vertex) {
        ends_[vertex] = ends_[sewn.of(vertex)];
        knot_of_[vertex] = knot_of_[sewn.of(vertex)];
        if (knot_of_[vertex] >= 0) knots_[knot_of_[vertex]].vertices.push_back(vertex);
    }
}

/// Each end of an edge with several points belongs to the nearest of them.
void SewnRest::find_ends(DisjointSets& sewn) {
    struct Point {
        double share;
        int knot;
    };
    std::map<std::pair<int, int>, std::vector<Point>> of_edge;
    for (int knot = 0; knot < static_cast<int>(knots_.size()); ++knot) {
        for (const Stitch& point : knots_[knot].points) {
            const auto [low, high] = std::minmax(point.from, point.to);
            of_edge[{low, high}].push_back({point.from == low ? point.share : 1.0 - point.share, knot});
        }
    }
    for (const auto& [edge, points] : of_edge) {
        const auto [nearest, farthest] = std::ranges::minmax_element(points, {}, &Point::share);
        ends_[sewn.of(edge.first)].push_back(nearest->knot);
        ends_[sewn.of(edge.second)].push_back(farthest->knot);
    }
}

void SewnRest::find_paths(int knot, const ClothSurface& surface, std::span<const Vec3> rest, double reach) {
    SewnFront front(reach);
    const auto reach_knot = [&](int number, double length) {
        for (const int vertex : knots_[number].vertices) front.reach_vertex(vertex, length);
    };
    reach_knot(knot, 0.0);
    for (const Stitch& point : knots_[knot].points) {
        const double edge = (rest[point.to] - rest[point.from]).norm();
        // Every feature that holds the edge is at the knot and needs a path to it.
        front.start_at(point.from, point.share * edge);
        front.start_at(point.to, (1.0 - point.share) * edge);
    }
    for (auto [vertex, length] = front.next(); vertex >= 0; std::tie(vertex, length) = front.next()) {
        if (knot_of_[vertex] >= 0) reach_knot(knot_of_[vertex], length);
        for (const int neighbour : surface.neighbours(vertex)) {
            front.reach_vertex(neighbour, length + (rest[neighbour] - rest[vertex]).norm());
        }
    }
    for (const auto& [vertex, length] : front.lengths()) paths_[vertex].push_back({knot, length});
}

/// Whether one of the knot's points that is no vertex is on the feature.
bool SewnRest::lies_at(std::span<const int> feature, int knot) const {
    const std::vector<Stitch>& points = knots_[knot].points;
    return std::any_of(points.begin(), points.end(),
                       [&](const Stitch& point) { return holds(feature, point.from) && holds(feature, point.to); });
}

bool SewnRest::is_at(std::span<const int> feature, int knot) const {
    return lies_at(feature, knot) || std::any_of(feature.begin(), feature.end(), [&](int v) { return knot_of_[v] == knot; });
}

/// Whether the feature holds such an end of a knot that the other feature is at.
bool SewnRest::ends_at(std::span<const int> feature, std::span<const int> other) const {
    return std::any_of(feature.begin(), feature.end(), [&](int vertex) {
        const std::vector<int>& knots = ends_[vertex];
        return std::any_of(knots.begin(), knots.end(), [&](int knot) { return is_at(other, knot); });
    });
}

bool SewnRest::overlap(std::span<const int> first, std::span<const int> second) const {
    return !knots_.empty() && (ends_at(first, second) || ends_at(second, first));
}

/// The knots near a feature, ascending, each with the shortest path to it.
class SewnRest::NearKnots {
public:
    NearKnots(const SewnRest& sewn, std::span<const int> feature) : sewn_(sewn), feature_(feature) {
        for (const int vertex : feature) {
            const std::vector<Path>& paths = sewn.paths_[vertex];
            if (!paths.empty()) left_[count_++] = paths;
        }
        find_next();
    }
    bool at_end() const { return here_.knot < 0; }
    const Path& here() const { return here_; }
    void find_next() {
        here_ = {};
        for (int k = 0; k < count_; ++k) {
            if (!left_[k].empty() && (at_end() || left_[k].front().knot < here_.knot)) here_ = left_[k].front();
        }
        if (at_end()) return;
        for (int k = 0; k < count_; ++k) {
            if (left_[k].empty() || left_[k].front().knot != here_.knot) continue;
            here_.length = std::min(here_.length, left_[k].front().length);
            left_[k] = left_[k].subspan(1);
        }
        if (feature_.size() > 1 && sewn_.lies_at(feature_, here_.knot)) here_.length = 0.0;
    }

private:
    const SewnRest& sewn_;
    std::span<const int> feature_;
    std::array<std::span<const Path>, 3> left_;  // remaining paths of each vertex that has any
    int count_ = 0;
    Path here_;
};

double SewnRest::distance(std::span<const int> first, std::span<const int> second) const {
    if (knots_.empty()) return unreachable;
    double shortest = unreachable;
    NearKnots a(*this, first), b(*this, second);
    while (!a.at_end() && !b.at_end()) {
        const int of_a = a.here().knot, of_b = b.here().knot;
        if (of_a == of_b) shortest = std::min(shortest, a.here().length + b.here().length);
        if (of_a <= of_b) a.find_next();
        if (of_b <= of_a) b.find_next();
    }
    return shortest;
}

}  // namespace percale
