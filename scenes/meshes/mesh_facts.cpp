#include "meshes/mesh_facts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>

#include "meshes/point_cells.h"

namespace percale::scenes {
namespace {

/// Height of a triangle over its longest edge, in lengths of that. Flat ones have no area, as check_mesh of the engine has it:
/// if the two differ, `percale doctor` passes what a run refuses. Slivers are warned of.
constexpr double flat_height = 1e-12, sliver_height = 1e-2;

/// The number of largest solids that a part turned inside out is compared with before it counts as inverted. More: slower.
constexpr std::size_t max_solids = 100;

/// For each vertex the first one at the same place.
std::vector<int> first_at_place(const std::vector<Vec3>& x) {
    std::vector<int> order(x.size()), first(x.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](int v) { return std::tie(x[v].x(), x[v].y(), x[v].z()); };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool again = i > 0 && key(order[i]) == key(order[i - 1]);
        first[order[i]] = again ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// Height over the longest edge, in its lengths; 0 where all corners are at one place.
double relative_height(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return longest > 0.0 ? (b - a).cross(c - a).norm() / longest : 0.0;
}

/// An edge as one triangle has it.
struct Side {
    VertexPair ends;  // sorted
    int opposite;     // the triangle's third vertex
    bool forward;     // the triangle passes it from the lower number to the higher
};

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if (a != b) sides.push_back({{std::min(a, b), std::max(a, b)}, t[(k + 2) % 3], a < b});
        }
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b) { return std::tie(a.ends, a.opposite) < std::tie(b.ends, b.opposite); });
    return sides;
}

/// Sets of numbers that grow together.
class Union {
public:
    explicit Union(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
    /// The lowest number of the set.
    int lowest(int i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(int a, int b) {
        const int low = lowest(a), high = lowest(b);
        parent_[std::max(low, high)] = std::min(low, high);
    }

private:
    std::vector<int> parent_;
};

void add_edge(std::span<const Side> uses, const TriangleMesh& mesh, MeshFacts& facts) {
    const VertexPair ends = uses[0].ends;
    if (uses.size() == 1) facts.open_edges.push_back(ends);
    if (uses.size() > 2) facts.crowded_edges.push_back(ends);
    if (uses.size() != 2) return;
    if (uses[0].forward == uses[1].forward) facts.contrary_edges.push_back(ends);
    const int a = uses[0].opposite, b = uses[1].opposite;
    if (a != b && mesh.vertices[a] == mesh.vertices[b]) facts.folded_flat.push_back({a, b});
}

void add_edges(const TriangleMesh& mesh, std::span<const Side> sides, MeshFacts& facts) {
    std::vector<double> lengths;
    for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
        while (end < sides.size() && sides[end].ends == sides[first].ends) ++end;
        add_edge(sides.subspan(first, end - first), mesh, facts);
        lengths.push_back((mesh.vertices[sides[first].ends[0]] - mesh.vertices[sides[first].ends[1]]).norm());
    }
    if (lengths.empty()) return;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    facts.median_edge = *middle;
    facts.shortest_edge = *std::min_element(lengths.begin(), middle + 1);
    facts.longest_edge = *std::max_element(middle, lengths.end());
}

/// A vertex is pinched if its corners, joined where two triangles have an edge at it in common, are more than one set.
std::vector<int> pinched(const TriangleMesh& mesh) {
    struct Spoke {
        int vertex, other, corner;
    };
    std::vector<Spoke> spokes;
    spokes.reserve(6 * mesh.triangles.size());
    for (int corner = 0; corner < static_cast<int>(3 * mesh.triangles.size()); ++corner) {
        const Triangle& t = mesh.triangles[corner / 3];
        for (int k = 1; k < 3; ++k) spokes.push_back({t[corner % 3], t[(corner + k) % 3], corner});
    }
    std::sort(spokes.begin(), spokes.end(),
              [](const Spoke& a, const Spoke& b) { return std::tie(a.vertex, a.other) < std::tie(b.vertex, b.other); });
    Union sets(3 * mesh.triangles.size());
    for (std::size_t i = 1; i < spokes.size(); ++i) {
        const Spoke &one = spokes[i - 1], &next = spokes[i];
        if (one.vertex == next.vertex && one.other == next.other) sets.join(one.corner, next.corner);
    }
    std::vector<int> count(mesh.vertices.size(), 0), result;
    for (int corner = 0; corner < static_cast<int>(3 * mesh.triangles.size()); ++corner)
        if (sets.lowest(corner) == corner) ++count[mesh.triangles[corner / 3][corner % 3]];
    for (std::size_t v = 0; v < count.size(); ++v)
        if (count[v] > 1) result.push_back(static_cast<int>(v));
    return result;
}

/// Pieces of a mesh, by the lowest vertex of each.
struct Part {
    bool used = false;
    bool open = false;
    double volume = 0.0;  // six times, m^3
    Vec3 lowest = Vec3::Constant(std::numeric_limits<double>::infinity()), highest = -lowest;

    bool holds(const Part& other) const {
        return (lowest.array() < other.lowest.array()).all() && (other.highest.array() < highest.array()).all();
    }
};

std::vector<Part> parts_of(const TriangleMesh& mesh, const MeshFacts& facts, Union& joined) {
    std::vector<Part> parts(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) {
        const int first = joined.lowest(t[0]);
        const auto from_first = [&](int v) -> Vec3 { return mesh.vertices[v] - mesh.vertices[first]; };
        parts[first].used = true;
        parts[first].volume += from_first(t[0]).dot(from_first(t[1]).cross(from_first(t[2])));
        for (const int v : t) {
            parts[first].lowest = parts[first].lowest.cwiseMin(mesh.vertices[v]);
            parts[first].highest = parts[first].highest.cwiseMax(mesh.vertices[v]);
        }
    }
    for (const auto* edges : {&facts.open_edges, &facts.crowded_edges, &facts.contrary_edges})
        for (const VertexPair& edge : *edges) parts[joined.lowest(edge[0])].open = true;
    return parts;
}

std::vector<Part> largest_solids(const std::vector<Part>& parts) {
    std::vector<Part> solids;
    for (const Part& part : parts)
        if (part.used && !part.open && part.volume > 0.0) solids.push_back(part);
    std::sort(solids.begin(), solids.end(), [](const Part& a, const Part& b) { return a.volume > b.volume; });
    if (solids.size() > max_solids) solids.resize(max_solids);
    return solids;
}

/// A closed part whose volume is below 0 is a cavity if one of the hundred largest that are not is around it.
void add_parts(const TriangleMesh& mesh, MeshFacts& facts) {
    Union joined(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles)
        for (const int v : t) joined.join(t[0], v);
    const std::vector<Part> parts = parts_of(mesh, facts, joined);
    const std::vector<Part> solids = largest_solids(parts);
    for (std::size_t v = 0; v < parts.size(); ++v) {
        const Part& part = parts[v];
        facts.parts += part.used;
        if (!part.used || part.open || part.volume >= 0.0) continue;
        if (std::none_of(solids.begin(), solids.end(), [&](const Part& solid) { return solid.holds(part); }))
            facts.inverted_parts.push_back(static_cast<int>(v));
    }
}

void add_vertices(const TriangleMesh& mesh, MeshFacts& facts) {
    Part all;
    for (const Triangle& t : mesh.triangles) {
        for (const int v : t) {
            all.lowest = all.lowest.cwiseMin(mesh.vertices[v]);
            all.highest = all.highest.cwiseMax(mesh.vertices[v]);
        }
    }
    if (!mesh.triangles.empty()) facts.lowest = all.lowest, facts.highest = all.highest;
    const std::vector<int> first = first_at_place(mesh.vertices);
    for (int v = 0; v < static_cast<int>(first.size()); ++v) {
        if (first[v] != v) facts.repeated_places.push_back(v);
    }
}

}  // namespace

std::vector<int> unused_vertices(const TriangleMesh& mesh) {
    std::vector<bool> used(mesh.vertices.size(), false);
    for (const Triangle& t : mesh.triangles)
        for (const int v : t) used[v] = true;
    std::vector<int> unused;
    for (int v = 0; v < static_cast<int>(used.size()); ++v)
        if (!used[v]) unused.push_back(v);
    return unused;
}

std::vector<int> repeated_triangles(const std::vector<Triangle>& triangles) {
    std::vector<std::pair<Triangle, int>> sorted(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        Triangle corners = triangles[i];
        std::sort(corners.begin(), corners.end());
        sorted[i] = {corners, static_cast<int>(i)};
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<int> again;
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i].first == sorted[i - 1].first) again.push_back(sorted[i].second);
    std::sort(again.begin(), again.end());
    return again;
}

MeshFacts mesh_facts(const TriangleMesh& mesh) {
    MeshFacts facts;
    add_vertices(mesh, facts);
    facts.unused_vertices = unused_vertices(mesh);
    facts.repeated_triangles = repeated_triangles(mesh.triangles);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double height = relative_height(mesh, mesh.triangles[i]);
        if (!(height > flat_height))
            facts.flat_triangles.push_back(static_cast<int>(i));
        else if (height < sliver_height)
            facts.slivers.push_back(static_cast<int>(i));
    }
    add_edges(mesh, sorted_sides(mesh.triangles), facts);
    facts.pinched_vertices = pinched(mesh);
    add_parts(mesh, facts);
    return facts;
}

bool is_watertight(const TriangleMesh& mesh) {
    const std::vector<Side> sides = sorted_sides(mesh.triangles);
    for (std::size_t first = 0; first < sides.size(); first += 2) {
        const bool two = first + 1 < sides.size() && sides[first].ends == sides[first + 1].ends;
        const bool more = first + 2 < sides.size() && sides[first].ends == sides[first + 2].ends;
        if (!two || more || sides[first].forward == sides[first + 1].forward) return false;
    }
    return true;
}

NearRims near_rims(const TriangleMesh& mesh, const MeshFacts& facts, double distance) {
    std::vector<VertexPair> joined;
    std::vector<int> rim;
    for (const VertexPair& edge : facts.open_edges) rim.insert(rim.end(), edge.begin(), edge.end());
    std::sort(rim.begin(), rim.end());
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    for (const Side& side : sorted_sides(mesh.triangles)) joined.push_back(side.ends);
    std::sort(joined.begin(), joined.end());

    // The shortest rim edge at each vertex: a vertex nearer than half of it lies on another part of the rim.
    std::vector<double> shortest(mesh.vertices.size(), std::numeric_limits<double>::infinity());
    for (const auto& [a, b] : facts.open_edges) {
        const double length = (mesh.vertices[a] - mesh.vertices[b]).norm();
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
    }

    PointCells cells(distance);
    for (const int v : rim) cells.add(v, mesh.vertices[v]);
    const auto gap_to_nearest = [&](int v) {
        double gap = std::numeric_limits<double>::infinity();
        cells.any_around(mesh.vertices[v], [&](int other) {
            const double apart = (mesh.vertices[v] - mesh.vertices[other]).norm();
            const double limit = std::min({distance, 0.5 * shortest[v], 0.5 * shortest[other], gap});
            const VertexPair pair = {std::min(v, other), std::max(v, other)};
            if (apart > 0.0 && apart < limit && !std::binary_search(joined.begin(), joined.end(), pair)) gap = apart;
            return false;
        });
        return gap;
    };
    NearRims near;
    for (const int v : rim) {
        const double gap = gap_to_nearest(v);
        if (std::isinf(gap)) continue;
        near.vertices.push_back(v);
        near.widest = std::max(near.widest, gap);
    }
    return near;
}

JoinedMesh joined_by_place(const TriangleMesh& mesh) {
    const std::vector<int> first = first_at_place(mesh.vertices);
    std::vector<Triangle> joined;
    for (const Triangle& t : mesh.triangles) joined.push_back({first[t[0]], first[t[1]], first[t[2]]});
    const std::vector<int> again = repeated_triangles(joined);
    JoinedMesh result;
    result.mesh.vertices = mesh.vertices;
    for (std::size_t i = 0; i < joined.size(); ++i) {
        const int number = static_cast<int>(i);
        if (!(relative_height(mesh, joined[i]) > flat_height) || std::binary_search(again.begin(), again.end(), number)) continue;
        result.mesh.triangles.push_back(joined[i]);
        result.number.push_back(number);
    }
    return result;
}

}  // namespace percale::scenes
