#include "lists/contact_pair.h"

#include <algorithm>
#include <cmath>

#include "geometry/triangle_distance.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Fraction of h. The edge-edge mollifier reaches 1 at the angle at which the ends of the edges are this much farther away than
/// the middle. 0: Newton did not end where threads lie along facets (330 iterations a step instead of 8). Larger: crossings at
/// small angles get too soft.
constexpr double negligible_rise = 1e-3;

/// A mollifier below it counts as 0. It covers rounding alone.
constexpr double min_mollifier = 1e-12;

std::array<Vec3, 3> corners(const Obstacle& obstacle, int triangle, double fraction) {
    const Triangle& t = obstacle.surface().triangles[triangle];
    return {obstacle.at(t[0], fraction), obstacle.at(t[1], fraction), obstacle.at(t[2], fraction)};
}

std::array<Vec3, 2> ends(const Obstacle& obstacle, int edge, double fraction) {
    const auto& [a, b] = obstacle.surface().edges[edge].vertex;
    return {obstacle.at(a, fraction), obstacle.at(b, fraction)};
}

PointTriangle vertex_on_face(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction) {
    const auto [a, b, c] = corners(obstacle, pair.feature, fraction);
    return closest_on_triangle(cloth[pair.cloth[0]], a, b, c);
}

PointTriangle vertex_on_cloth(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction) {
    return closest_on_triangle(obstacle.at(pair.feature, fraction), cloth[pair.cloth[0]], cloth[pair.cloth[1]],
                               cloth[pair.cloth[2]]);
}

EdgeEdge edges(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction) {
    const auto [a, b] = ends(obstacle, pair.feature, fraction);
    return closest_on_edges(cloth[pair.cloth[0]], cloth[pair.cloth[1]], a, b);
}

void set_direction(PairContact& contact) {
    const Vec3 apart = contact.cloth_point - contact.obstacle_point;
    contact.distance = apart.norm();
    if (contact.distance > 0.0) contact.direction = apart / contact.distance;
}

PairContact edge_edge_contact(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction) {
    const EdgeEdge closest = edges(pair, cloth, obstacle, fraction);
    const auto [a, b] = ends(obstacle, pair.feature, fraction);
    const Vec3 &p = cloth[pair.cloth[0]], &q = cloth[pair.cloth[1]];
    PairContact contact{.weight = {1.0 - closest.s, closest.s, 0.0, 0.0},
                        .cloth_point = p + closest.s * (q - p),
                        .obstacle_point = a + closest.t * (b - a)};
    set_direction(contact);
    const Vec3 u = q - p, v = b - a;
    contact.crossing = std::sqrt(u.cross(v).squaredNorm() / std::max(u.squaredNorm(), v.squaredNorm()));
    const auto& [va, vb] = obstacle.surface().edges[pair.feature].vertex;
    contact.obstacle_displacement = (1.0 - closest.t) * obstacle.displacement(va) + closest.t * obstacle.displacement(vb);
    const bool inside = closest.s > 0.0 && closest.s < 1.0 && closest.t > 0.0 && closest.t < 1.0;
    const auto at = [&](int vertex) { return obstacle.at(vertex, fraction); };
    contact.local_minimum = inside && obstacle.surface().edges[pair.feature].can_touch &&
                            edge_faces(obstacle.surface(), pair.feature, contact.obstacle_point, contact.direction, at);
    return contact;
}

/// Whether this cloth triangle reports a closest point on an edge of it: it owns the edge, and cloth across the edge comes no
/// nearer. Without the second condition the numbering of triangles would decide whether a contact beside an edge pushes once or
/// twice.
bool cloth_edge_reports(const ContactPair& pair, int edge, std::span<const Vec3> cloth, const PairContact& contact) {
    if ((pair.edge_bits >> edge & 1U) == 0) return false;
    if (pair.across[edge] < 0) return true;
    const Vec3 away = cloth[pair.across[edge]] - contact.cloth_point;
    return away.dot(contact.direction) >= -tolerances::rising_sine * away.norm();
}

PairContact face_vertex_contact(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction) {
    const PointTriangle closest = vertex_on_cloth(pair, cloth, obstacle, fraction);
    PairContact contact{.weight = {closest.weight[0], closest.weight[1], closest.weight[2], 0.0},
                        .cloth_point = closest.point,
                        .obstacle_point = obstacle.at(pair.feature, fraction),
                        .obstacle_displacement = obstacle.displacement(pair.feature)};
    set_direction(contact);
    // A closest point at a cloth vertex is the vertex's own contact with the obstacle's faces.
    const bool own = closest.region == TriangleRegion::face ||
                     (closest.region == TriangleRegion::edge && cloth_edge_reports(pair, closest.corner, cloth, contact));
    const auto at = [&](int vertex) { return obstacle.at(vertex, fraction); };
    contact.local_minimum = own && obstacle.surface().vertex_can_touch[pair.feature] &&
                            vertex_faces(obstacle.surface(), pair.feature, contact.direction, at);
    return contact;
}

}  // namespace

double edge_mollifier(const PairContact& contact, double thickness) {
    // At a distance d the ends are (crossing/2)^2/(2 d) farther off than the middle.
    const double rise = contact.crossing * contact.crossing / (8.0 * thickness), x = rise / (negligible_rise * thickness);
    if (x < min_mollifier) return 0.0;
    return x < 1.0 ? x * (2.0 - x) : 1.0;
}

Vec3 pair_apart(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction) {
    switch (pair.kind) {
        case PairKind::vertex_face:
            return cloth[pair.cloth[0]] - vertex_on_face(pair, cloth, obstacle, fraction).point;
        case PairKind::edge_edge: {
            const EdgeEdge closest = edges(pair, cloth, obstacle, fraction);
            const auto [a, b] = ends(obstacle, pair.feature, fraction);
            const Vec3 &p = cloth[pair.cloth[0]], &q = cloth[pair.cloth[1]];
            return (p - a) + closest.s * (q - p) - closest.t * (b - a);
        }
        default:
            return vertex_on_cloth(pair, cloth, obstacle, fraction).point - obstacle.at(pair.feature, fraction);
    }
}

double pair_distance(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction) {
    return pair_apart(pair, cloth, obstacle, fraction).norm();
}

PairContact pair_contact(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction) {
    return pair.kind == PairKind::edge_edge ? edge_edge_contact(pair, cloth, obstacle, fraction)
                                            : face_vertex_contact(pair, cloth, obstacle, fraction);
}

void fetch_pair(const ContactPair& pair, const Obstacle& obstacle, int depth) {
    const ObstacleSurface& surface = obstacle.surface();
    const bool edges = pair.kind == PairKind::edge_edge;
    if (depth == 0) {
        if (pair.kind == PairKind::vertex_face) __builtin_prefetch(&surface.triangles[pair.feature]);
        if (pair.kind == PairKind::face_vertex) __builtin_prefetch(&surface.ring_start[pair.feature]);
        if (edges) __builtin_prefetch(&surface.edges[pair.feature]);
        if (edges) __builtin_prefetch(&surface.opposite_start[pair.feature]);
        return;
    }
    const auto fetch_all = [&](std::span<const int> vertices) {
        for (const int vertex : vertices) obstacle.fetch(vertex);
    };
    if (pair.kind == PairKind::vertex_face) {
        if (depth == 1) fetch_all(surface.triangles[pair.feature]);
        return;
    }
    const std::span<const int> around = edges ? surface.opposites(pair.feature) : surface.neighbours(pair.feature);
    if (depth == 2) return fetch_all(around);
    __builtin_prefetch(around.data());
    if (edges) fetch_all(surface.edges[pair.feature].vertex);
    if (!edges) obstacle.fetch(pair.feature);
}

MovingFour moving_pair(const ContactPair& pair, const ClothMove& move, const Obstacle& obstacle) {
    MovingFour four;
    const int count = pair.cloth_count();
    // A face with an obstacle vertex is a point-triangle pair whose point is the obstacle's.
    const int first_cloth = pair.kind == PairKind::face_vertex ? 1 : 0;
    for (int k = 0; k < count; ++k) {
        four.from[first_cloth + k] = move.from[pair.cloth[k]];
        four.to[first_cloth + k] = move.to[pair.cloth[k]];
    }
    const auto set_obstacle = [&](int slot, int vertex) {
        four.from[slot] = obstacle.at(vertex, move.fraction.from);
        four.to[slot] = obstacle.at(vertex, move.fraction.to);
    };
    if (pair.kind == PairKind::vertex_face) {
        for (int k = 0; k < 3; ++k) set_obstacle(1 + k, obstacle.surface().triangles[pair.feature][k]);
    } else if (pair.kind == PairKind::edge_edge) {
        for (int k = 0; k < 2; ++k) set_obstacle(2 + k, obstacle.surface().edges[pair.feature].vertex[k]);
    } else {
        set_obstacle(0, pair.feature);
    }
    return four;
}

}  // namespace percale
