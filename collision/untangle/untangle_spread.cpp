#include "untangle/untangle_spread.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace percale {
namespace {

/// Length lost by a move for each length along the cloth. 1: edges may double or vanish; 0.5 stretches them by at most 12 %.
/// Small: cloth far away moves, too.
constexpr double move_slope = 0.5;

/// The size of a faded move at a vertex; larger ones are propagated first, at equal size the lower vertex (Dijkstra 1959).
struct Front {
    double size;
    int vertex, source;
    bool operator<(const Front& other) const { return size != other.size ? size < other.size : vertex > other.vertex; }
};

/// For each vertex the source whose value, less the loss along the length to it, is largest there, and that value; source -1
/// below `smallest`.
struct Reached {
    std::vector<double> size;
    std::vector<int> source;
};

Reached pass_on(const TangledCloth& cloth, std::span<const Vec3> x, std::vector<Front> start, double loss, double smallest) {
    Reached reached{std::vector<double>(x.size(), smallest), std::vector<int>(x.size(), -1)};
    std::priority_queue<Front> fronts;
    const auto offer = [&](const Front& front) {
        if (!(front.size > reached.size[front.vertex])) return;
        reached.size[front.vertex] = front.size;
        reached.source[front.vertex] = front.source;
        fronts.push(front);
    };
    for (const Front& front : start) offer(front);
    while (!fronts.empty()) {
        const Front front = fronts.top();
        fronts.pop();
        if (front.size < reached.size[front.vertex]) continue;
        for (const int other : cloth.neighbours[front.vertex]) {
            offer({front.size - loss * (x[other] - x[front.vertex]).norm(), other, front.source});
        }
    }
    return reached;
}

}  // namespace

std::vector<double> distance_from_fixed(const TangledCloth& cloth, std::span<const Vec3> positions) {
    std::vector<Front> fixed;
    for (int v = 0; v < cloth.vertex_count(); ++v) {
        if (!(cloth.free[v] > 0.0)) fixed.push_back({0.0, v, v});
    }
    const Reached reached = pass_on(cloth, positions, std::move(fixed), 1.0, -std::numeric_limits<double>::infinity());
    std::vector<double> distance;
    for (const double size : reached.size) distance.push_back(-size);
    return distance;
}

void spread_moves(const TangledCloth& cloth, std::span<const Vec3> positions, const std::vector<bool>& core,
                  std::span<const double> limit, std::vector<Vec3>& moves) {
    std::vector<Front> start;
    for (int v = 0; v < cloth.vertex_count(); ++v) {
        if (core[v]) start.push_back({moves[v].norm(), v, v});
    }
    const Reached reached = pass_on(cloth, positions, std::move(start), move_slope, 0.0);
    for (int v = 0; v < cloth.vertex_count(); ++v) {
        const int source = reached.source[v];
        if (!core[v]) moves[v] = Vec3::Zero();
        if (!core[v] && source >= 0) moves[v] = reached.size[v] * moves[source].normalized();
        if (moves[v].norm() > limit[v]) moves[v] *= limit[v] / moves[v].norm();
    }
}

double largest_stretch(const TangledCloth& cloth, std::span<const Vec3> from, std::span<const Vec3> to) {
    double largest = 0.0;
    for (const Triangle& t : cloth.triangles) {
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            const double before = (from[b] - from[a]).norm();
            if (before > 0.0) largest = std::max(largest, (to[b] - to[a]).norm() / before - 1.0);
        }
    }
    return largest;
}

}  // namespace percale
