#include "rest_edges.h"

#include <algorithm>
#include <cmath>

#include "percale/error.h"

namespace percale {
namespace {

/// Radians up to which a triangle of a rest shape lies on its neighbour and both count as unfolded. 0: rounding decides.
constexpr double rest_fold = 1e-6;

/// Fraction of a given warp that must lie in the plane of each triangle. Smaller: warp is rounding there. Larger: bodies of
/// cloth that curve away from it are refused.
constexpr double min_warp_ratio = 1e-3;

/// A triangle beside an edge: the ends of the edge, and the opposite vertex.
struct EdgeSide {
    Vec3 low = Vec3::Zero(), high = Vec3::Zero(), opposite = Vec3::Zero();

    double length() const { return (high - low).norm(); }
};

/// Places of an edge's ends in its one or two triangles.
struct EdgeSides {
    std::array<EdgeSide, 2> side;
    int count = 0;
};

bool lies_flat_on(const EdgeSide& one, const EdgeSide& other) {
    const Vec3 along = one.high - one.low, first = along.cross(one.opposite - one.low),
               second = along.cross(other.opposite - one.low);
    // Normals that point the same way: both opposite vertices are on one side.
    return first.dot(second) > 0.0 && first.cross(second).norm() <= rest_fold * first.norm() * second.norm();
}

/// The opposite vertex of `other`, unfolded into the plane of `one` on the side across the edge: as high over the edge, its foot
/// at the same fraction.
Vec3 unfolded(const EdgeSide& one, const EdgeSide& other) {
    const Vec3 edge = other.high - other.low, to_opposite = other.opposite - other.low;
    const double fraction = edge.dot(to_opposite) / edge.squaredNorm(), height = edge.cross(to_opposite).norm() / edge.norm();
    const Vec3 along = one.high - one.low, across = along.cross(one.opposite - one.low).cross(along);
    return one.low + fraction * along - height * across.normalized();
}

RestEdge rest_edge(const EdgeSides& sides) {
    const auto& [first, second] = sides.side;
    RestEdge edge{{first.low, first.high, first.opposite, Vec3::Zero()}, first.length()};
    if (sides.count < 2) return edge;
    const bool joined = first.low == second.low && first.high == second.high;
    if (!joined) edge.length = 0.5 * (first.length() + second.length());
    edge.corner[3] = joined && !lies_flat_on(first, second) ? second.opposite : unfolded(first, second);
    return edge;
}

Vec3 warp_direction(const ShapedMesh& rest, std::size_t t, const std::array<Vec3, 3>& x) {
    const TriangleMesh& mesh = rest.mesh;
    const Triangle& triangle = mesh.triangles[t];
    if (const Vec3& warp = rest.shape.warp; warp != Vec3::Zero()) {
        const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
        return (warp - warp.dot(normal) * normal).normalized();
    }
    for (int e = 0; mesh.is_grid() && e < 3; ++e) {
        const auto [a, b] = std::minmax(triangle[e], triangle[(e + 1) % 3]);
        if (b - a == 1) return (mesh.vertices[b] - mesh.vertices[a]).normalized();
    }
    return (x[1] - x[0]).normalized();
}

}  // namespace

std::array<Vec3, 3> rest_corners(const TriangleMesh& mesh, const RestShape& shape, std::size_t triangle) {
    if (!shape.corners.empty()) return shape.corners[triangle];
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

std::array<Eigen::Vector2d, 3> corners_in_plane(const ShapedMesh& rest, std::size_t triangle) {
    const std::array<Vec3, 3> corners = rest_corners(rest.mesh, rest.shape, triangle);
    const Vec3 x = warp_direction(rest, triangle, corners);
    const Vec3 first = corners[1] - corners[0], second = corners[2] - corners[0];
    const Vec3 y = first.cross(second).normalized().cross(x);
    return {Eigen::Vector2d::Zero(), Eigen::Vector2d(first.dot(x), first.dot(y)), Eigen::Vector2d(second.dot(x), second.dot(y))};
}

std::vector<RestEdge> rest_edges(std::span<const Triangle> triangles, std::span<const MeshEdge> edges,
                                 std::span<const std::array<Vec3, 3>> corners) {
    std::vector<EdgeSides> sides(edges.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
            const bool ascending = triangles[t][a] < triangles[t][b];
            const std::size_t low = ascending ? a : b, high = ascending ? b : a;
            const std::array<int, 2> ends = {triangles[t][low], triangles[t][high]};
            const auto found = std::lower_bound(edges.begin(), edges.end(), ends,
                                                [](const MeshEdge& e, const std::array<int, 2>& key) { return e.vertex < key; });
            EdgeSides& at = sides[static_cast<std::size_t>(found - edges.begin())];
            at.side[at.count++] = {corners[t][low], corners[t][high], corners[t][k]};
        }
    }
    std::vector<RestEdge> result;
    std::transform(sides.begin(), sides.end(), std::back_inserter(result), rest_edge);
    return result;
}

RestShape rest_shape_of(const TriangleMesh& mesh, const TriangleMesh& rest, const std::string& name) {
    if (rest.triangles.size() != mesh.triangles.size()) {
        throw SceneError(name, "its rest shape has " + std::to_string(rest.triangles.size()) + " triangles, the mesh has " +
                                   std::to_string(mesh.triangles.size()) + "; both need the same");
    }
    const auto differing = std::mismatch(mesh.triangles.begin(), mesh.triangles.end(), rest.triangles.begin()).first;
    if (differing != mesh.triangles.end()) {
        throw SceneError(name, "triangle " + std::to_string(differing - mesh.triangles.begin()) +
                                   " of its rest shape has other vertices than that of the mesh");
    }
    RestShape shape;
    for (std::size_t t = 0; t < rest.triangles.size(); ++t) shape.corners.push_back(rest_corners(rest, {}, t));
    return shape;
}

void check_rest_shape(const TriangleMesh& mesh, const RestShape& shape, const std::string& name) {
    if (!shape.said()) return;
    if (mesh.is_grid()) throw SceneError(name, "a grid is its own rest shape, and its warp runs along its rows");
    if (!shape.corners.empty() && shape.corners.size() != mesh.triangles.size()) {
        throw SceneError(name, "its rest shape has " + std::to_string(shape.corners.size()) + " triangles, the mesh has " +
                                   std::to_string(mesh.triangles.size()));
    }
    if (!shape.warp.allFinite()) throw SceneError(name, "the direction of its warp is not finite");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = rest_corners(mesh, shape, t);
        const std::string triangle = "triangle " + std::to_string(t) + " of its rest shape ";
        const Vec3 normal = (b - a).cross(c - a);
        if (!normal.allFinite()) throw SceneError(name, triangle + "is not finite");
        if (!has_area(a, b, c)) throw SceneError(name, triangle + "has no area");
        const double across = shape.warp.cross(normal).norm();
        if (shape.warp != Vec3::Zero() && !(across > min_warp_ratio * shape.warp.norm() * normal.norm()))
            throw SceneError(name, "its warp stands upright on " + triangle);
    }
}

}  // namespace percale
