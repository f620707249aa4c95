#include "obstacle/obstacle_packs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "geometry/morton_order.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Triangles of the obstacle in a patch, the unit of a backend's tree. The order of the constraints depends on it, as on the
/// cluster's.
constexpr unsigned long triangles_per_patch = 16;

/// Twice the area over the square of the longest edge. Narrower triangles have no normal that excludes contacts of an edge.
/// Smaller: a wrong normal may exclude a real contact. Larger: cost alone.
constexpr double needle_area = 1e-4;

/// Twice the area over the square of the longest edge, of a triangle whose sharpness is bounded. Narrower ones are measured
/// exactly.
constexpr double flat_triangle_area = 1e-12;

/// Constants of the cone of directions in which a vertex can be closest. `ray_below`: dot product of unit vectors up to which a
/// ray is below an edge; 0 loses rays to rounding, the cone gets too narrow and contacts are missed. `parallel_edges`: length of
/// a cross product below which two edges give no ray. The others affect cost alone: length of the sum of rays below which there
/// is no cone; cosine of the widest cone worth a test; edges at the vertex worth the search.
constexpr double ray_below = 1e-6, parallel_edges = 1e-3, min_ray_sum = 0.5, widest_cone = 0.2;
constexpr unsigned long max_cone_edges = 16;

constexpr double boundless = std::numeric_limits<double>::infinity();

class PackMaker {
public:
    PackMaker(const ObstacleSurface& surface, ObstaclePacks& packs) : surface_(surface), packs_(packs) {}

    void add_patch(std::span<const int> triangles) {
        add_kind(PairKind::vertex_face, {triangles.begin(), triangles.end()});
        std::vector<int> edges, vertices;
        for (const int triangle : triangles) {
            for (const int edge : surface_.triangle_edges[triangle]) {
                if (surface_.edges[edge].owner == triangle && surface_.edges[edge].can_touch) edges.push_back(edge);
            }
            for (const int vertex : surface_.triangles[triangle]) {
                if (surface_.vertex_owner[vertex] == triangle && surface_.vertex_can_touch[vertex]) vertices.push_back(vertex);
            }
        }
        add_kind(PairKind::edge_edge, edges);
        add_kind(PairKind::face_vertex, vertices);
    }

private:
    void add_kind(PairKind kind, const std::vector<int>& features) {
        packs_.first.push_back(static_cast<int>(packs_.packs.size()));
        for (std::size_t from = 0; from < features.size(); from += pack_lanes) {
            FeaturePack& pack = packs_.packs.emplace_back();
            packs_.patch_of_pack.push_back(static_cast<int>(packs_.first.size() - 1) / 3);
            pack.kind = kind;
            pack.count = static_cast<int>(std::min<std::size_t>(pack_lanes, features.size() - from));
            for (int lane = 0; lane < pack_lanes; ++lane) {
                pack.feature[lane] = features[from + std::min(lane, pack.count - 1)];
                if (lane >= pack.count) continue;
                packs_.place_of[static_cast<int>(kind)][pack.feature[lane]] =
                    pack_lanes * (static_cast<int>(packs_.packs.size()) - 1) + lane;
            }
        }
    }

    const ObstacleSurface& surface_;
    ObstaclePacks& packs_;
};

std::span<const int> vertices_of(const ObstacleSurface& surface, PairKind kind, const int& feature) {
    if (kind == PairKind::vertex_face) return surface.triangles[feature];
    if (kind == PairKind::edge_edge) return surface.edges[feature].vertex;
    return {&feature, 1};
}

void set_row(PackLanes& lanes, int row, int lane, const Vec3& value) {
    for (int axis = 0; axis < 3; ++axis) lanes.at[row + axis][lane] = static_cast<float>(value[axis]);
}

/// Unit normal of the triangle of an edge and a third vertex; zero for a needle, whose normal is inaccurate.
Vec3 normal_at(const Vec3& a, const Vec3& b, const Vec3& opposite) {
    const Vec3 normal = (b - a).cross(opposite - a);
    const double longest = std::max({(b - a).squaredNorm(), (opposite - a).squaredNorm(), (opposite - b).squaredNorm()});
    const double area = normal.norm();
    return area > needle_area * longest ? Vec3(normal / area) : Vec3(Vec3::Zero());
}

/// The normals of the two triangles at an edge, on one side of the surface; both zero if there are not exactly two.
std::array<Vec3, 2> edge_normals(const ObstacleSurface& surface, int edge, const VertexPaths& paths) {
    const std::span<const int> opposite = surface.opposites(edge);
    if (opposite.size() != 2) return {Vec3::Zero(), Vec3::Zero()};
    const Vec3 a = paths.start[surface.edges[edge].vertex[0]], b = paths.start[surface.edges[edge].vertex[1]];
    const Vec3 first = normal_at(a, b, paths.start[opposite[0]]), second = normal_at(b, a, paths.start[opposite[1]]);
    if (first.isZero() || second.isZero()) return {Vec3::Zero(), Vec3::Zero()};
    return {first, second};
}

/// Cone of the directions in which a vertex can be closest.
struct Cone {
    Vec3 axis = Vec3::Zero();
    double cosine = -1.0;  // of the half angle; -1 = any direction, 2 = none
};

/// Rays of the cone { d : d . e <= 0 for all edges e at the vertex }: products of two edges that keep the others below.
std::vector<Vec3> extreme_rays(std::span<const Vec3> edges) {
    const auto are_below = [&](const Vec3& ray) {
        return std::all_of(edges.begin(), edges.end(), [&](const Vec3& e) { return e.dot(ray) <= ray_below; });
    };
    std::vector<Vec3> rays;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const Vec3 product = edges[i].cross(edges[k]);
            if (product.norm() < parallel_edges) continue;
            const Vec3 ray = product.normalized();
            if (are_below(ray)) rays.push_back(ray);
            if (are_below(-ray)) rays.push_back(-ray);
        }
    }
    return rays;
}

Cone cone_at(const ObstacleSurface& surface, int vertex, const VertexPaths& paths) {
    const std::span<const int> ring = surface.neighbours(vertex);
    if (ring.size() > max_cone_edges) return {};
    std::vector<Vec3> edges;
    for (const int other : ring) edges.push_back((paths.start[other] - paths.start[vertex]).normalized());
    const std::vector<Vec3> rays = extreme_rays(edges);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& ray : rays) sum += ray;
    if (sum.norm() < min_ray_sum) return {};
    Cone cone{.axis = sum.normalized(), .cosine = 1.0};
    for (const Vec3& ray : rays) cone.cosine = std::min(cone.cosine, cone.axis.dot(ray));
    return cone.cosine > widest_cone ? cone : Cone{};
}

/// Where a pack's features are at a fraction of the step.
struct PlacedPaths {
    const ObstacleSurface& surface;
    const VertexPaths& paths;
    double fraction;
};

void place_points(const FeaturePack& pack, const PlacedPaths& there, int lane, PlacedPack& placed) {
    const std::span<const int> vertices = vertices_of(there.surface, pack.kind, pack.feature[lane]);
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        x[k] = there.paths.at(vertices[k], there.fraction) - placed.centre;
        set_row(placed.lanes, 3 * static_cast<int>(k), lane, x[k]);
        placed.radius = std::max(placed.radius, tolerances::rounded_up * static_cast<float>(x[k].cwiseAbs().maxCoeff()));
    }
    if (pack.kind == PairKind::vertex_face)
        placed.sharpness = std::max(placed.sharpness, static_cast<float>(longest_over_area(x[0], x[1], x[2])));
    if (pack.kind == PairKind::edge_edge)
        placed.shortest_edge = std::min(placed.shortest_edge, static_cast<float>((x[1] - x[0]).norm()));
}

void place_directions(const FeaturePack& pack, const ObstacleSurface& surface, const VertexPaths& paths, int lane,
                      PackLanes& lanes) {
    if (pack.kind == PairKind::edge_edge) {
        const auto [first, second] = edge_normals(surface, pack.feature[lane], paths);
        set_row(lanes, 6, lane, first);
        set_row(lanes, 9, lane, second);
    } else if (pack.kind == PairKind::face_vertex) {
        const Cone cone = cone_at(surface, pack.feature[lane], paths);
        set_row(lanes, 3, lane, cone.axis);
        lanes.at[6][lane] = static_cast<float>(cone.cosine);
    }
}

/// Calls work(triangle) for all triangles of a patch.
template <class Work>
void for_triangles(const ObstaclePacks& packs, int patch, Work work) {
    const auto [first, last] = packs.packs_of(patch, PairKind::vertex_face);
    for (int number = first; number < last; ++number) {
        const FeaturePack& pack = packs.packs[number];
        for (int lane = 0; lane < pack.count; ++lane) work(pack.feature[lane]);
    }
}

/// The mean normal of the triangles of a patch, at the start of the step.
Vec3 patch_normal(const ObstaclePacks& packs, int patch, const ObstacleSurface& surface, const VertexPaths& paths) {
    Vec3 normal = Vec3::Zero();
    for_triangles(packs, patch, [&](int triangle) {
        const auto& [a, b, c] = surface.triangles[triangle];
        normal += (paths.start[b] - paths.start[a]).cross(paths.start[c] - paths.start[a]);
    });
    return normal.norm() > 0.0 ? Vec3(normal.normalized()) : Vec3(Vec3::UnitY());
}

void add_paths(std::span<const int> vertices, const VertexPaths& paths, Box& box) {
    for (const int vertex : vertices) {
        box.add(paths.start[vertex]);
        box.add(paths.end[vertex]);
    }
}

float not_above(double x) {
    const auto near = static_cast<float>(x);
    return static_cast<double>(near) > x ? std::nextafter(near, -std::numeric_limits<float>::infinity()) : near;
}

/// The hull of a pack with a plane of this normal.
PackHull make_hull(const FeaturePack& pack, const ObstacleSurface& surface, const VertexPaths& paths, const Vec3& normal) {
    PackHull hull{.normal = normal, .offset = -boundless};
    Box box;
    for (int lane = 0; lane < pack.count; ++lane) {
        const std::span<const int> vertices = vertices_of(surface, pack.kind, pack.feature[lane]);
        add_paths(vertices, paths, box);
        for (const int vertex : vertices) {
            hull.offset = std::max({hull.offset, normal.dot(paths.start[vertex]), normal.dot(paths.end[vertex])});
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        hull.low[axis] = not_above(box.low[axis]);
        hull.high[axis] = -not_above(-box.high[axis]);
    }
    return hull;
}

}  // namespace

double longest_over_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = b - a, v = c - a, w = c - b;
    const double area = u.cross(v).norm(), longest = std::max({u.squaredNorm(), v.squaredNorm(), w.squaredNorm()});
    return area > flat_triangle_area * longest ? std::sqrt(longest) / area : boundless;
}

ObstaclePacks make_packs(const ObstacleSurface& surface) {
    ObstaclePacks packs;
    const std::vector<int> order = morton_order(surface.triangles, surface.vertices);
    packs.place_of[0].assign(surface.triangles.size(), -1);
    packs.place_of[1].assign(surface.edges.size(), -1);
    packs.place_of[2].assign(surface.vertices.size(), -1);
    PackMaker maker(surface, packs);
    for (std::size_t from = 0; from < order.size(); from += triangles_per_patch) {
        maker.add_patch(std::span(order).subspan(from, std::min(triangles_per_patch, order.size() - from)));
    }
    packs.box.resize(packs.first.size() / 3);
    packs.first.push_back(static_cast<int>(packs.packs.size()));
    packs.hulls.resize(packs.packs.size());
    packs.placed.resize(packs.packs.size());
    return packs;
}

void set_boxes(ObstaclePacks& packs, const ObstacleSurface& surface, const VertexPaths& paths) {
    for (std::size_t patch = 0; patch < packs.patch_count(); ++patch) {
        Box box;
        for_triangles(packs, static_cast<int>(patch), [&](int triangle) { add_paths(surface.triangles[triangle], paths, box); });
        packs.box[patch] = box;
    }
}

void set_hulls(ObstaclePacks& packs, int patch, const ObstacleSurface& surface, const VertexPaths& paths) {
    const Vec3 normal = patch_normal(packs, patch, surface, paths);
    for (int number = packs.first[3 * patch]; number < packs.first[3 * patch + 3]; ++number) {
        packs.hulls[number] = make_hull(packs.packs[number], surface, paths, normal);
    }
}

PatchMotion motion_of(const ObstaclePacks& packs, int patch, const ObstacleSurface& surface, const VertexPaths& paths) {
    PatchMotion motion;
    double corners = 0.0;
    for_triangles(packs, patch, [&](int triangle) {
        for (const int vertex : surface.triangles[triangle]) motion.mean += paths.end[vertex] - paths.start[vertex];
        corners += 3.0;
    });
    motion.mean /= std::max(1.0, corners);
    for_triangles(packs, patch, [&](int triangle) {
        for (const int vertex : surface.triangles[triangle])
            motion.spread = std::max(motion.spread, (paths.end[vertex] - paths.start[vertex] - motion.mean).norm());
    });
    return motion;
}

bool is_placed(const PlacedPack& placed, const VertexPaths& paths, double fraction) {
    const double there = std::atomic_ref(const_cast<double&>(placed.fraction)).load(std::memory_order_acquire);
    return there >= 0.0 && (paths.rest() || there == fraction);
}

const PlacedPack& place(ObstaclePacks& packs, int number, const ObstacleSurface& surface, const VertexPaths& paths,
                        double fraction) {
    PlacedPack& placed = packs.placed[number];
    if (is_placed(placed, paths, fraction)) return placed;
    const FeaturePack& pack = packs.packs[number];
    Box box;
    for (const int feature : pack.feature) {
        for (const int vertex : vertices_of(surface, pack.kind, feature)) box.add(paths.at(vertex, fraction));
    }
    std::atomic_ref(placed.fraction).store(-1.0, std::memory_order_relaxed);  // other threads may read meanwhile
    placed.centre = 0.5 * (box.low + box.high);
    placed.radius = placed.sharpness = 0.0F;
    placed.shortest_edge = std::numeric_limits<float>::infinity();
    placed.all = static_cast<unsigned char>((1U << pack.count) - 1U);
    placed.lanes = {};
    for (int lane = 0; lane < pack_lanes; ++lane) {
        place_points(pack, {surface, paths, fraction}, lane, placed);
        if (pack.kind == PairKind::face_vertex) placed.lanes.at[6][lane] = -1.0F;
        if (paths.rest()) place_directions(pack, surface, paths, lane, placed.lanes);
    }
    // This store comes last: threads that see it may read the rest.
    std::atomic_ref(placed.fraction).store(fraction, std::memory_order_release);
    return placed;
}

}  // namespace percale
