#include "obstacle/obstacle_surface.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "obstacle/face_sides.h"
#include "percale/error.h"

namespace percale {
namespace {

/// Twice the area over the square of the longest edge. Triangles with less are dropped when an obstacle is cleaned. Larger: real
/// needles vanish from the surface. Smaller: triangles without a direction remain.
constexpr double degenerate_area = 1e-14;

/// Length of the sum of two unit vectors. Two triangles continue each other below it, and cloth does not meet their edge. Larger:
/// ridges of finely meshed bodies are taken for flat, and cloth meets only their faces. Smaller: flat faces get edge contacts.
constexpr double flat_fold = 1e-9;

struct ByPlace {
    bool operator()(const Vec3& a, const Vec3& b) const { return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z()); }
};

/// For each vertex the first one at the same place.
std::vector<int> merge_vertices(std::span<const Vec3> vertices, int& merged) {
    std::map<Vec3, int, ByPlace> first_at;
    std::vector<int> first_there(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto [entry, added] = first_at.try_emplace(vertices[i], static_cast<int>(i));
        first_there[i] = entry->second;
        if (!added) ++merged;
    }
    return first_there;
}

bool has_area(std::span<const Vec3> x, const Triangle& t) {
    const Vec3 u = x[t[1]] - x[t[0]], v = x[t[2]] - x[t[0]], w = x[t[2]] - x[t[1]];
    const double longest = std::max({u.squaredNorm(), v.squaredNorm(), w.squaredNorm()});
    return u.cross(v).norm() > degenerate_area * longest;
}

Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
}

/// Triangles of a deforming surface without area stay, because they may get one. `numbers`, where not null, gets the numbers of
/// the triangles that are kept.
void keep_good_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles, SurfaceShape shape,
                         ObstacleSurface& surface, std::vector<int>* numbers = nullptr) {
    const std::vector<int> merged = merge_vertices(vertices, surface.cleaning.merged_vertices);
    std::map<Triangle, int> seen;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle t{merged[triangles[i][0]], merged[triangles[i][1]], merged[triangles[i][2]]};
        const bool distinct = t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        if (!distinct || (shape == SurfaceShape::rigid && !has_area(vertices, t))) {
            ++surface.cleaning.degenerate_triangles;
        } else if (!seen.try_emplace(sorted(t), 0).second) {
            ++surface.cleaning.duplicate_triangles;
        } else {
            surface.triangles.push_back(t);
            if (numbers != nullptr) numbers->push_back(static_cast<int>(i));
        }
    }
}

/// Keeps the vertices that a triangle of the surface uses; `given` holds their numbers in the given mesh.
void keep_used_vertices(std::span<const Vec3> vertices, std::span<const int> given, ObstacleSurface& surface) {
    std::vector<int> number(vertices.size(), -1);
    for (const Triangle& t : surface.triangles) {
        for (const int vertex : t) number[vertex] = 0;
    }
    surface.vertices.clear();
    surface.given.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (number[i] < 0) continue;
        number[i] = static_cast<int>(surface.vertices.size());
        surface.vertices.push_back(vertices[i]);
        surface.given.push_back(given[i]);
    }
    for (Triangle& t : surface.triangles) {
        for (int& vertex : t) vertex = number[vertex];
    }
}

void drop_unused_vertices(std::span<const Vec3> vertices, ObstacleSurface& surface) {
    std::vector<int> all(vertices.size());
    std::iota(all.begin(), all.end(), 0);
    keep_used_vertices(vertices, all, surface);
    surface.cleaning.unreferenced_vertices =
        static_cast<int>(vertices.size() - surface.vertices.size()) - surface.cleaning.merged_vertices;
}

/// Cleans vertices and triangles alone, without connectivity.
ObstacleSurface clean(std::span<const Vec3> vertices, std::span<const Triangle> triangles, SurfaceShape shape) {
    ObstacleSurface surface;
    keep_good_triangles(vertices, triangles, shape, surface);
    if (surface.triangles.empty()) {
        throw SceneError("the obstacle has no triangle with an area (" + std::to_string(triangles.size()) +
                         " given, all degenerate)");
    }
    drop_unused_vertices(vertices, surface);
    surface.cleaning.triangles = static_cast<int>(surface.triangles.size());
    return surface;
}

/// A half edge of a triangle, to be sorted by its vertices.
struct HalfEdge {
    int low, high, triangle, corner;
    bool forward;  // runs from low to high
};

std::vector<HalfEdge> half_edges(const ObstacleSurface& surface) {
    std::vector<HalfEdge> halves;
    halves.reserve(3 * surface.triangles.size());
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const int a = surface.triangles[i][k], b = surface.triangles[i][(k + 1) % 3];
            halves.push_back({std::min(a, b), std::max(a, b), static_cast<int>(i), k, a < b});
        }
    }
    std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return halves;
}

void connect_edges(ObstacleSurface& surface) {
    surface.edges.clear();
    surface.opposite.clear();
    const std::vector<HalfEdge> halves = half_edges(surface);
    surface.triangle_edges.resize(surface.triangles.size());
    surface.opposite_start.assign(1, 0);
    surface.watertight = true;
    for (std::size_t i = 0; i < halves.size();) {
        const HalfEdge& first = halves[i];
        const int edge = static_cast<int>(surface.edges.size());
        surface.edges.push_back({{first.low, first.high}, first.triangle, true});
        std::size_t end = i;
        int direction = 0;
        for (; end < halves.size() && halves[end].low == first.low && halves[end].high == first.high; ++end) {
            const HalfEdge& half = halves[end];
            surface.triangle_edges[half.triangle][half.corner] = edge;
            surface.opposite.push_back(surface.triangles[half.triangle][(half.corner + 2) % 3]);
            direction += half.forward ? 1 : -1;
        }
        surface.watertight = surface.watertight && end - i == 2 && direction == 0;
        surface.opposite_start.push_back(static_cast<int>(surface.opposite.size()));
        i = end;
    }
}

void connect_vertices(ObstacleSurface& surface) {
    const std::size_t count = surface.vertices.size();
    std::vector<std::vector<int>> edges_at(count);
    for (std::size_t e = 0; e < surface.edges.size(); ++e) {
        for (const int vertex : surface.edges[e].vertex) edges_at[vertex].push_back(static_cast<int>(e));
    }
    surface.ring.clear();
    surface.ring_edges.clear();
    surface.ring_start.assign(1, 0);
    for (std::size_t v = 0; v < count; ++v) {
        for (const int e : edges_at[v]) {
            const auto& [a, b] = surface.edges[e].vertex;
            surface.ring.push_back(a == static_cast<int>(v) ? b : a);
            surface.ring_edges.push_back(e);
        }
        surface.ring_start.push_back(static_cast<int>(surface.ring.size()));
    }
    surface.vertex_owner.assign(count, -1);
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        for (const int vertex : surface.triangles[i]) {
            if (surface.vertex_owner[vertex] < 0) surface.vertex_owner[vertex] = static_cast<int>(i);
        }
    }
}

/// Unit vector in the plane of a triangle from its edge ab towards its third vertex, perpendicular to the edge.
Vec3 into_triangle(const Vec3& a, const Vec3& b, const Vec3& opposite) {
    const Vec3 along = (b - a).normalized(), away = opposite - a;
    return (away - along.dot(away) * along).normalized();
}

/// How the two triangles of an edge lie to each other.
struct Fold {
    bool flat;      // they continue each other
    double height;  // of the second one over the plane of the first, at distance 1 from the edge: > 0 is a valley
};

Fold fold(const ObstacleSurface& surface, int edge, std::span<const Vec3> x) {
    const SurfaceEdge& e = surface.edges[edge];
    const Triangle& t = surface.triangles[e.owner];
    const Vec3 normal = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).normalized();
    const std::span<const int> opposite = surface.opposites(edge);  // the owner's first
    const Vec3 &a = x[e.vertex[0]], &b = x[e.vertex[1]];
    const Vec3 first = into_triangle(a, b, x[opposite[0]]), second = into_triangle(a, b, x[opposite[1]]);
    // Neither vector is 0: a triangle without area continues nothing.
    const bool flat = first.dot(second) < 0.0 && (first + second).norm() <= flat_fold;
    return {.flat = flat, .height = second.dot(normal)};
}

/// The same with its vertices at these places. Most edges are not flat, which follows at once from their four vertices: the
/// volume that they span is at most the fold's height times these lengths.
bool is_flat(const ObstacleSurface& surface, int edge, std::span<const Vec3> x) {
    const auto& [a, b] = surface.edges[edge].vertex;
    const std::span<const int> opposite = surface.opposites(edge);
    if (opposite.size() != 2) return false;
    const Vec3 along = x[b] - x[a], first = x[opposite[0]] - x[a], second = x[opposite[1]] - x[a];
    const double volume = along.cross(first).dot(second);
    const double lengths = along.squaredNorm() * first.squaredNorm() * second.squaredNorm();
    constexpr double min = 2.0 * flat_fold;
    return volume * volume <= min * min * lengths && fold(surface, edge, x).flat;
}

/// The sides that both triangles of each edge have; unproven where they differ.
std::vector<FaceSides> sides_at_edges(const ObstacleSurface& surface, std::span<const FaceSides> sides) {
    std::vector<FaceSides> at_edge(surface.edges.size());
    for (std::size_t i = 0; i < at_edge.size(); ++i) at_edge[i] = sides[surface.edges[i].owner];
    for (std::size_t i = 0; i < sides.size(); ++i) {
        for (const int edge : surface.triangle_edges[i]) {
            if (sides[i] != at_edge[edge]) at_edge[edge] = FaceSides::unproven;
        }
    }
    return at_edge;
}

/// Whether an edge is a valley seen from outside the solid. The free space at it is a wedge of less than half a turn, which
/// contains no line through the edge: a cloth edge that comes there ends there, or meets a face first.
bool is_free_valley(const Fold& fold, FaceSides sides) {
    return (sides == FaceSides::outward && fold.height > flat_fold) || (sides == FaceSides::inward && fold.height < -flat_fold);
}

/// `sides` are those of the triangles of a closed surface; empty for others.
void mark_touchable(ObstacleSurface& surface, std::span<const FaceSides> sides) {
    const std::vector<FaceSides> at_edge =
        sides.empty() ? std::vector(surface.edges.size(), FaceSides::unproven) : sides_at_edges(surface, sides);
    surface.vertex_can_touch.assign(surface.vertices.size(), false);
    for (std::size_t i = 0; i < surface.edges.size(); ++i) {
        SurfaceEdge& edge = surface.edges[i];
        if (surface.opposites(static_cast<int>(i)).size() == 2) {
            const Fold found = fold(surface, static_cast<int>(i), surface.vertices);
            edge.can_touch = !found.flat && !is_free_valley(found, at_edge[i]);
        }
        if (!edge.can_touch) continue;
        for (const int vertex : edge.vertex) surface.vertex_can_touch[vertex] = true;
    }
}

void connect(ObstacleSurface& surface) {
    connect_edges(surface);
    connect_vertices(surface);
}

/// The solid stays the same, so a closed surface still counts as closed. Returns the sides of the remaining triangles.
std::vector<FaceSides> drop_internal_faces(ObstacleSurface& surface) {
    std::vector<FaceSides> sides = face_sides(surface.vertices, surface.triangles);
    std::vector<Triangle> left;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i] != FaceSides::internal) left.push_back(surface.triangles[i]);
    }
    surface.cleaning.internal_triangles = static_cast<int>(sides.size() - left.size());
    if (surface.cleaning.internal_triangles == 0) return sides;
    std::erase(sides, FaceSides::internal);
    surface.triangles = std::move(left);
    surface.cleaning.triangles = static_cast<int>(surface.triangles.size());
    keep_used_vertices(std::vector<Vec3>(surface.vertices), std::vector<int>(surface.given), surface);
    connect(surface);
    surface.watertight = true;
    return sides;
}

}  // namespace

ObstacleSurface make_surface(std::span<const Vec3> vertices, std::span<const Triangle> triangles, SurfaceShape shape) {
    ObstacleSurface surface = clean(vertices, triangles, shape);
    connect(surface);
    if (shape == SurfaceShape::deforming) {
        surface.vertex_can_touch.assign(surface.vertices.size(), true);
        return surface;
    }
    mark_touchable(surface, surface.watertight ? drop_internal_faces(surface) : std::vector<FaceSides>());
    return surface;
}

TriangleMesh solid_of(const TriangleMesh& mesh, std::vector<int>& numbers) {
    ObstacleSurface surface;
    numbers.clear();
    keep_good_triangles(mesh.vertices, mesh.triangles, SurfaceShape::rigid, surface, &numbers);
    return {.vertices = mesh.vertices, .triangles = std::move(surface.triangles)};
}

void mark_flat(std::span<const Vec3> start, std::span<const Vec3> end, ObstacleSurface& surface) {
    surface.vertex_can_touch.assign(surface.vertices.size(), false);
    for (std::size_t i = 0; i < surface.edges.size(); ++i) {
        SurfaceEdge& edge = surface.edges[i];
        const int number = static_cast<int>(i);
        edge.can_touch = !is_flat(surface, number, end) || !is_flat(surface, number, start);
        if (!edge.can_touch) continue;
        for (const int vertex : edge.vertex) surface.vertex_can_touch[vertex] = true;
    }
}

CleaningReport cleaning_report(const TriangleMesh& mesh, bool deforming) {
    return make_surface(mesh.vertices, mesh.triangles, deforming ? SurfaceShape::deforming : SurfaceShape::rigid).cleaning;
}

}  // namespace percale
