#include "self/sewn_rest.h"

#include <algorithm>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "geometry/disjoint_sets.h"

namespace percale {
namespace {

constexpr double unreachable = std::numeric_limits<double>::infinity();

/// Shortest paths from one place, as they are found.
class SewnFront {
public:
    explicit SewnFront(double reach) : reach_(reach) {}

    void reach_vertex(int vertex, double length) {
        if (length > reach_) return;
        const auto [known, is_new] = length_.try_emplace(vertex, length);
        if (!is_new && known->second <= length) return;
        known->second = length;
        open_.emplace(length, vertex);
    }
    /// The nearest vertex from which nothing was reached yet, with its length; -1: there is none.
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

/// Of an edge with several points each end is that of the nearest.
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
        front.reach_vertex(point.from, point.share * edge);
        front.reach_vertex(point.to, (1.0 - point.share) * edge);
    }
    for (auto [vertex, length] = front.next(); vertex >= 0; std::tie(vertex, length) = front.next()) {
        if (knot_of_[vertex] >= 0) reach_knot(knot_of_[vertex], length);
        for (const int neighbour : surface.neighbours(vertex)) {
            front.reach_vertex(neighbour, length + (rest[neighbour] - rest[vertex]).norm());
        }
    }
    for (const auto& [vertex, length] : front.lengths()) paths_[vertex].push_back({knot, length});
}

/// Whether one of its points, if no vertex of it, is on the feature.
bool SewnRest::lies_at(std::span<const int> feature, int knot) const {
    const std::vector<Stitch>& points = knots_[knot].points;
    return std::any_of(points.begin(), points.end(),
                       [&](const Stitch& point) { return holds(feature, point.from) && holds(feature, point.to); });
}

bool SewnRest::is_at(std::span<const int> feature, int knot) const {
    return lies_at(feature, knot) || std::any_of(feature.begin(), feature.end(), [&](int v) { return knot_of_[v] == knot; });
}

/// Whether the feature holds such an end of a knot at which the other is.
bool SewnRest::ends_at(std::span<const int> feature, std::span<const int> other) const {
    return std::any_of(feature.begin(), feature.end(), [&](int vertex) {
        const std::vector<int>& knots = ends_[vertex];
        return std::any_of(knots.begin(), knots.end(), [&](int knot) { return is_at(other, knot); });
    });
}

bool SewnRest::overlap(std::span<const int> first, std::span<const int> second) const {
    return !knots_.empty() && (ends_at(first, second) || ends_at(second, first));
}

double SewnRest::distance(std::span<const int> first, std::span<const int> second) const {
    if (knots_.empty()) return unreachable;
    const auto length_to = [&](std::span<const int> feature, int knot) {
        if (lies_at(feature, knot)) return 0.0;
        double shortest = unreachable;
        for (const int vertex : feature) {
            const std::vector<Path>& paths = paths_[vertex];
            const auto found =
                std::lower_bound(paths.begin(), paths.end(), knot, [](const Path& path, int k) { return path.knot < k; });
            if (found != paths.end() && found->knot == knot) shortest = std::min(shortest, found->length);
        }
        return shortest;
    };
    double shortest = unreachable;
    for (const int vertex : first) {
        for (const Path& path : paths_[vertex]) {
            shortest = std::min(shortest, length_to(first, path.knot) + length_to(second, path.knot));
        }
    }
    return shortest;
}

}  // namespace percale
