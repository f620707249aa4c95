#include "obstacle/obstacle_surface.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "obstacle/internal_faces.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale {
namespace {

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
    return u.cross(v).norm() > tolerances::degenerate_area * longest;
}

Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
}

/// Of a deforming surface those without area stay: they may get one.
void keep_good_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles, SurfaceShape shape,
                         ObstacleSurface& surface) {
    const std::vector<int> merged = merge_vertices(vertices, surface.cleaning.merged_vertices);
    std::map<Triangle, int> seen;
    for (const Triangle& original : triangles) {
        const Triangle t{merged[original[0]], merged[original[1]], merged[original[2]]};
        const bool distinct = t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        if (!distinct || (shape == SurfaceShape::rigid && !has_area(vertices, t))) {
            ++surface.cleaning.degenerate_triangles;
        } else if (!seen.try_emplace(sorted(t), 0).second) {
            ++surface.cleaning.duplicate_triangles;
        } else {
            surface.triangles.push_back(t);
        }
    }
}

/// Keeps of `vertices`, which have these numbers in the given mesh, those that a triangle of the surface uses.
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

/// Vertices and triangles alone, without connectivity.
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
    std::vector<std::vector<int>> rings(count);
    for (const SurfaceEdge& edge : surface.edges) {
        rings[edge.vertex[0]].push_back(edge.vertex[1]);
        rings[edge.vertex[1]].push_back(edge.vertex[0]);
    }
    surface.ring.clear();
    surface.ring_start.assign(1, 0);
    for (const std::vector<int>& ring : rings) {
        surface.ring.insert(surface.ring.end(), ring.begin(), ring.end());
        surface.ring_start.push_back(static_cast<int>(surface.ring.size()));
    }
    surface.vertex_owner.assign(count, -1);
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        for (const int vertex : surface.triangles[i]) {
            if (surface.vertex_owner[vertex] < 0) surface.vertex_owner[vertex] = static_cast<int>(i);
        }
    }
}

/// Unit vector in the plane of a triangle from its edge ab towards its third vertex, square to the edge.
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
    // Neither is 0: a triangle without area continues nothing.
    const bool flat = first.dot(second) < 0.0 && (first + second).norm() <= tolerances::flat_fold;
    return {.flat = flat, .height = second.dot(normal)};
}

/// The same with its vertices at these places. Most edges are no such, which their four vertices tell at once: the volume that
/// they span is at most the fold's height times these lengths.
bool is_flat(const ObstacleSurface& surface, int edge, std::span<const Vec3> x) {
    const auto& [a, b] = surface.edges[edge].vertex;
    const std::span<const int> opposite = surface.opposites(edge);
    if (opposite.size() != 2) return false;
    const Vec3 along = x[b] - x[a], first = x[opposite[0]] - x[a], second = x[opposite[1]] - x[a];
    const double volume = along.cross(first).dot(second);
    const double lengths = along.squaredNorm() * first.squaredNorm() * second.squaredNorm();
    constexpr double least = 2.0 * tolerances::flat_fold;
    return volume * volume <= least * least * lengths && fold(surface, edge, x).flat;
}

/// For each vertex the first vertex of its connected component of the surface.
std::vector<int> connected_components(const ObstacleSurface& surface) {
    std::vector<int> component(surface.vertices.size(), -1), waiting;
    for (std::size_t seed = 0; seed < component.size(); ++seed) {
        if (component[seed] < 0) waiting.push_back(static_cast<int>(seed));
        while (!waiting.empty()) {
            const int vertex = waiting.back();
            waiting.pop_back();
            if (component[vertex] >= 0) continue;
            component[vertex] = static_cast<int>(seed);
            const std::span<const int> ring = surface.neighbours(vertex);
            waiting.insert(waiting.end(), ring.begin(), ring.end());
        }
    }
    return component;
}

/// Whether the normals of a closed surface point away from what it encloses, in each of its components: not on those turned
/// inside out nor around a cavity, where cloth may be behind a normal (inside is where the winding number is not 0).
bool faces_outwards(const ObstacleSurface& surface) {
    const std::vector<int> component = connected_components(surface);
    std::vector<double> volume(surface.vertices.size(), 0.0);  // six times, at the first vertex of each component
    for (const Triangle& t : surface.triangles) {
        const int first = component[t[0]];
        const auto from_first = [&](int v) -> Vec3 { return surface.vertices[v] - surface.vertices[first]; };
        volume[first] += from_first(t[0]).dot(from_first(t[1]).cross(from_first(t[2])));
    }
    for (std::size_t vertex = 0; vertex < component.size(); ++vertex) {
        if (component[vertex] == static_cast<int>(vertex) && !(volume[vertex] > 0.0)) return false;
    }
    return true;
}

void mark_touchable(ObstacleSurface& surface, bool valleys_are_safe) {
    surface.vertex_can_touch.assign(surface.vertices.size(), false);
    for (std::size_t i = 0; i < surface.edges.size(); ++i) {
        SurfaceEdge& edge = surface.edges[i];
        if (surface.opposites(static_cast<int>(i)).size() == 2) {
            const auto [flat, height] = fold(surface, static_cast<int>(i), surface.vertices);
            edge.can_touch = !flat && !(valleys_are_safe && height > 0.0);
        }
        if (!edge.can_touch) continue;
        for (const int vertex : edge.vertex) surface.vertex_can_touch[vertex] = true;
    }
}

void connect(ObstacleSurface& surface) {
    connect_edges(surface);
    connect_vertices(surface);
}

/// The solid stays the same, so a closed surface still counts as one.
void drop_internal_faces(ObstacleSurface& surface) {
    const std::vector<bool> internal = internal_faces(surface.vertices, surface.triangles);
    std::vector<Triangle> left;
    for (std::size_t i = 0; i < internal.size(); ++i) {
        if (!internal[i]) left.push_back(surface.triangles[i]);
    }
    surface.cleaning.internal_triangles = static_cast<int>(internal.size() - left.size());
    if (surface.cleaning.internal_triangles == 0) return;
    surface.triangles = std::move(left);
    surface.cleaning.triangles = static_cast<int>(surface.triangles.size());
    keep_used_vertices(std::vector<Vec3>(surface.vertices), std::vector<int>(surface.given), surface);
    connect(surface);
    surface.watertight = true;
}

}  // namespace

ObstacleSurface make_surface(std::span<const Vec3> vertices, std::span<const Triangle> triangles, SurfaceShape shape) {
    ObstacleSurface surface = clean(vertices, triangles, shape);
    connect(surface);
    if (shape == SurfaceShape::deforming) {
        surface.vertex_can_touch.assign(surface.vertices.size(), true);
        return surface;
    }
    const bool valleys_are_safe = surface.watertight && faces_outwards(surface);
    if (surface.watertight) drop_internal_faces(surface);
    mark_touchable(surface, valleys_are_safe);
    return surface;
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
