#include "certificate/inside_test.h"

#include <bit>
#include <cstdint>
#include <unordered_map>

#include "certificate/exact_orientation.h"

namespace percale::certificate {
namespace {

struct HashPlace {
    std::size_t operator()(const std::array<double, 3>& place) const {
        std::uint64_t hash = 0;
        for (const double value : place)
            hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
        return static_cast<std::size_t>(hash);
    }
};

/// The first vertex at the same place, for every vertex. 0 and -0 are one place.
std::vector<int> welded(std::span<const Vec3> vertices) {
    std::unordered_map<std::array<double, 3>, int, HashPlace> first;
    first.reserve(vertices.size());
    std::vector<int> result;
    result.reserve(vertices.size());
    for (const Vec3& x : vertices) {
        const std::array<double, 3> place = {x.x() + 0.0, x.y() + 0.0, x.z() + 0.0};
        result.push_back(first.try_emplace(place, static_cast<int>(result.size())).first->second);
    }
    return result;
}

bool has_area(const TriangleMesh& mesh, const Triangle& t) {
    return projection_axis(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]) >= 0;
}

/// Half-edges by their lower vertex: a counting sort, so that the whole check is linear.
struct HalfEdge {
    int upper;
    int sense;  // 1 from the lower vertex to the upper, -1 back
};

bool every_edge_paired(std::span<HalfEdge> at_one_vertex) {
    if (at_one_vertex.size() % 2 != 0) return false;
    std::sort(at_one_vertex.begin(), at_one_vertex.end(), [](const HalfEdge& a, const HalfEdge& b) { return a.upper < b.upper; });
    for (std::size_t i = 0; i < at_one_vertex.size(); i += 2) {
        const HalfEdge &a = at_one_vertex[i], &b = at_one_vertex[i + 1];
        if (a.upper != b.upper || a.sense + b.sense != 0) return false;
        if (i > 0 && at_one_vertex[i - 1].upper == a.upper) return false;
    }
    return true;
}

bool is_closed(std::span<const Triangle> triangles, int vertex_count) {
    std::vector<int> start(vertex_count + 1, 0);
    const auto for_each_half_edge = [&](auto&& visit) {
        for (const Triangle& t : triangles) {
            for (int i = 0; i < 3; ++i) visit(t[i], t[(i + 1) % 3]);
        }
    };
    for_each_half_edge([&](int from, int to) { ++start[std::min(from, to) + 1]; });
    for (int i = 0; i < vertex_count; ++i) start[i + 1] += start[i];
    std::vector<HalfEdge> edges(3 * triangles.size());
    std::vector<int> next(start.begin(), start.end() - 1);
    for_each_half_edge([&](int from, int to) { edges[next[std::min(from, to)]++] = {std::max(from, to), from < to ? 1 : -1}; });
    for (int i = 0; i < vertex_count; ++i) {
        if (!every_edge_paired({edges.begin() + start[i], edges.begin() + start[i + 1]})) return false;
    }
    return !triangles.empty();
}

int order(double a, double b) { return (a > b) - (a < b); }

/// Sign of (b - a) x (q' - a) in the y z plane for q' = q + (e, e^2): where the exact sign is 0, that of -(b - a)_z e, then of
/// (b - a)_y e^2. Antisymmetric in a and b, 0 only where both project to one point.
int perturbed_turn(const Vec3& a, const Vec3& b, const Vec3& q) {
    const int turn = orient2d(a, b, q, 0);
    if (turn != 0) return turn;
    return a.z() != b.z() ? order(a.z(), b.z()) : order(b.y(), a.y());
}

/// 1 where the ray leaves through the triangle (along its normal), -1 where it enters, 0 where it misses.
int crossing(const Vec3& point, const Corners& t) {
    const int turn = perturbed_turn(t[0], t[1], point);
    if (turn == 0 || perturbed_turn(t[1], t[2], point) != turn || perturbed_turn(t[2], t[0], point) != turn) return 0;
    return orient3d(t[0], t[1], t[2], point) * turn < 0 ? turn : 0;
}

}  // namespace

bool is_watertight(const TriangleMesh& mesh) {
    const std::vector<int> place = welded(mesh.vertices);
    std::vector<Triangle> whole, with_area;
    whole.reserve(mesh.triangles.size());
    for (const Triangle& given : mesh.triangles) {
        const Triangle t = {place[given[0]], place[given[1]], place[given[2]]};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) whole.push_back(t);
    }
    const int vertex_count = static_cast<int>(mesh.vertices.size());
    if (is_closed(whole, vertex_count)) return true;
    std::copy_if(whole.begin(), whole.end(), std::back_inserter(with_area), [&](const Triangle& t) { return has_area(mesh, t); });
    return with_area.size() < whole.size() && is_closed(with_area, vertex_count);
}

int winding_number(const Vec3& point, std::span<const Corners> triangles, const BoxTree& tree) {
    int winding = 0;
    const auto meets_ray = [&](const Box& box) {
        return box.high.x() >= point.x() && box.low.y() <= point.y() && point.y() <= box.high.y() && box.low.z() <= point.z() &&
               point.z() <= box.high.z();
    };
    tree.walk(meets_ray, [&](int item) { winding += crossing(point, triangles[item]); });
    return winding;
}

Side side_of(const Vec3& point, std::span<const Corners> triangles, const BoxTree& tree) {
    bool on_surface = false;
    tree.walk([&](const Box& box) { return !on_surface && box.contains(point); },
              [&](int item) { on_surface = on_surface || lies_on(point, triangles[item]); });
    if (on_surface) return Side::on_surface;
    return winding_number(point, triangles, tree) != 0 ? Side::inside : Side::outside;
}

}  // namespace percale::certificate
