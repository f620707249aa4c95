#include "untangle/edge_crossings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace percale {
namespace {

bool share_a_vertex(const std::array<int, 2>& edge, const Triangle& triangle) {
    return std::any_of(edge.begin(), edge.end(),
                       [&](int v) { return std::find(triangle.begin(), triangle.end(), v) != triangle.end(); });
}

/// Direction into the face of the line in which a face at an edge meets a plane; zero where they are parallel.
Vec3 into_face(const Vec3& plane_normal, const std::array<Vec3, 3>& face) {
    const auto& [a, b, opposite] = face;
    const Vec3 along = plane_normal.cross((b - a).cross(opposite - a));
    if (!(along.squaredNorm() > 0.0)) return Vec3::Zero();
    const Vec3 edge = (b - a).normalized();
    const Vec3 inwards = (opposite - a) - edge.dot(opposite - a) * edge;
    return (along.dot(inwards) < 0.0 ? -along : along).normalized();
}

/// Where the edge pierces the triangle; nothing where it does not.
std::optional<EdgeCrossing> crossing_of(const std::array<int, 2>& edge, const Triangle& triangle, std::span<const Vec3> x) {
    const Vec3 &a = x[triangle[0]], &b = x[triangle[1]], &c = x[triangle[2]];
    const Vec3 normal = (b - a).cross(c - a);
    const double below = normal.dot(x[edge[0]] - a), above = normal.dot(x[edge[1]] - a);
    if (!(std::signbit(below) != std::signbit(above)) || below == above) return std::nullopt;
    EdgeCrossing crossing{.edge = edge, .triangle = triangle};
    crossing.share = below / (below - above);
    const Vec3 point = x[edge[0]] + crossing.share * (x[edge[1]] - x[edge[0]]);
    const double area = normal.squaredNorm();
    crossing.weight[0] = normal.dot((b - point).cross(c - point)) / area;
    crossing.weight[1] = normal.dot((c - point).cross(a - point)) / area;
    crossing.weight[2] = 1.0 - crossing.weight[0] - crossing.weight[1];
    if (std::any_of(crossing.weight.begin(), crossing.weight.end(), [](double w) { return w < 0.0; })) return std::nullopt;
    return crossing;
}

void set_retreat(const ClothSurface::Edge& edge, std::span<const Vec3> x, EdgeCrossing& crossing) {
    const auto& [i, j, k] = crossing.triangle;
    const Vec3 normal = (x[j] - x[i]).cross(x[k] - x[i]).normalized();
    const Vec3 &from = x[edge.vertex[0]], &to = x[edge.vertex[1]];
    Vec3 sum = Vec3::Zero();
    for (const int opposite : edge.opposite) {
        if (opposite >= 0) sum += into_face(normal, {from, to, x[opposite]});
    }
    const Vec3 along = (to - from).normalized();
    const double steepness = along.dot(normal);
    crossing.retreat = steepness == 0.0 ? sum : Vec3(sum - 2.0 * along.dot(sum) / steepness * normal);
}

}  // namespace

std::vector<EdgeCrossing> edge_crossings(const ClothSurface& surface, std::span<const IntersectingPair> pairs,
                                         std::span<const Vec3> positions) {
    std::vector<std::array<int, 2>> candidates;  // edge, triangle
    for (const auto& [first, second] : pairs) {
        for (const int edge : surface.triangle_edges[first]) candidates.push_back({edge, second});
        for (const int edge : surface.triangle_edges[second]) candidates.push_back({edge, first});
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    std::vector<EdgeCrossing> crossings;
    for (const auto& [number, triangle] : candidates) {
        const ClothSurface::Edge& edge = surface.edges[number];
        if (share_a_vertex(edge.vertex, surface.triangles[triangle])) continue;
        std::optional<EdgeCrossing> crossing = crossing_of(edge.vertex, surface.triangles[triangle], positions);
        if (!crossing) continue;
        set_retreat(edge, positions, *crossing);
        crossings.push_back(*crossing);
    }
    return crossings;
}

}  // namespace percale
