#include "percale/certify.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <string>

#include "certificate/certificate_mesh.h"
#include "certificate/exact_orientation.h"
#include "certificate/inside_test.h"
#include "certificate/sewn_triangles.h"
#include "certificate/triangle_gap.h"
#include "certificate/triangle_overlap.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale {
namespace {

using namespace certificate;

constexpr double infinity = std::numeric_limits<double>::infinity();
// A distance of two boxes times this is a lower bound for their items, rounding included.
constexpr double below_bound = 1.0 - tolerances::bound_slack;

/// The caller's request to stop.
struct Cancel {
    const std::atomic<bool>* wish = nullptr;

    bool asked() const { return wish != nullptr && wish->load(std::memory_order_relaxed); }
    void check() const {
        if (asked()) throw CertificateCancelled();
    }
};

using Surface = CertificateMesh::Prepared;

void check_limit(double limit) {
    if (!(limit >= 0.0)) throw SceneError("certify: distance_limit is " + std::to_string(limit) + " m; it has to be 0 or more");
}

void sort(std::vector<IntersectingPair>& pairs) {
    std::sort(pairs.begin(), pairs.end(), [](const IntersectingPair& a, const IntersectingPair& b) {
        return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
}

/// Fills the pairs; returns for every cloth triangle whether it shares no point with the obstacle.
std::vector<bool> find_pairs(const Surface& cloth, const Surface& obstacle, const Cancel& cancel, Certificate& result) {
    std::vector<bool> free(cloth.triangles.size(), true);
    const auto visit = [&](int i, int j) {
        const Overlap overlap = classify(cloth.triangles[i], obstacle.triangles[j]);
        if (overlap == Overlap::disjoint) return;
        free[i] = false;
        if (overlap == Overlap::crossing) result.pairs.push_back({i, j});
        result.touching_pairs += overlap == Overlap::touching;
    };
    cloth.tree.walk_overlaps(obstacle.tree, visit, [&] { return cancel.asked(); });
    cancel.check();
    sort(result.pairs);
    return free;
}

/// Groups of cloth vertices joined by triangles that share no point with the obstacle: each group lies on one side of it.
class Groups {
public:
    Groups(const TriangleMesh& cloth, const std::vector<bool>& free) : parent_(cloth.vertices.size()) {
        std::iota(parent_.begin(), parent_.end(), 0);
        for (std::size_t i = 0; i < cloth.triangles.size(); ++i) {
            if (!free[i]) continue;
            join(cloth.triangles[i][0], cloth.triangles[i][1]);
            join(cloth.triangles[i][1], cloth.triangles[i][2]);
        }
    }

    int representative(int vertex) {
        while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
        return vertex;
    }

private:
    void join(int a, int b) {
        const int root_a = representative(a), root_b = representative(b);
        parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }

    std::vector<int> parent_;
};

std::vector<int> vertices_inside(const TriangleMesh& cloth, const Surface& obstacle, const std::vector<bool>& free,
                                 const Cancel& cancel) {
    Groups groups(cloth, free);
    const Box bounds = obstacle.tree.bounds();
    std::vector<bool> inside(cloth.vertices.size());
    std::vector<int> result;
    for (int v = 0; v < static_cast<int>(cloth.vertices.size()); ++v) {
        cancel.check();
        const int first = groups.representative(v);  // the lowest of its group, so already decided
        const Vec3& x = cloth.vertices[v];
        const auto own_side = [&] { return bounds.contains(x) && side_of(x, obstacle.triangles, obstacle.tree) == Side::inside; };
        inside[v] = first < v ? inside[first] : own_side();
        if (inside[v]) result.push_back(v);
    }
    return result;
}

double distance_to_surface(const Vec3& x, const Surface& surface) {
    Box here;
    here.add(x);
    const auto box_distance = [&](const Box& box) { return distance(here, box) * below_bound; };
    const auto item_distance = [&](int i) { return point_triangle_distance(x, surface.triangles[i]); };
    return surface.tree.nearest(infinity, box_distance, item_distance).second;
}

void measure_depth(const TriangleMesh& cloth, const Surface& obstacle, const std::vector<bool>& free, const Cancel& cancel,
                   Certificate& result) {
    result.inside_vertices = vertices_inside(cloth, obstacle, free, cancel);
    result.vertices_inside = static_cast<int>(result.inside_vertices.size());
    for (const int v : result.inside_vertices) {
        cancel.check();
        const double depth = distance_to_surface(cloth.vertices[v], obstacle);
        if (result.deepest_vertex >= 0 && depth <= result.deepest_penetration) continue;
        result.deepest_penetration = depth;
        result.deepest_vertex = v;
    }
}

double smallest_distance(const Surface& cloth, const Surface& obstacle, double limit, const Cancel& cancel) {
    std::vector<Slab> slabs;
    slabs.reserve(cloth.triangles.size());
    for (const Corners& triangle : cloth.triangles) slabs.push_back(slab_of(triangle));
    return cloth.tree.nearest_pair(obstacle.tree, limit, [&](int i, int j, double best) {
        cancel.check();
        const Corners &a = cloth.triangles[i], &b = obstacle.triangles[j];
        const double too_far = best / below_bound;
        return triangle_separation(a, slabs[i], b, too_far) > too_far ? infinity : triangle_distance(a, b);
    });
}

bool share_a_vertex(const Triangle& a, const Triangle& b) {
    return std::any_of(a.begin(), a.end(), [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

/// Whether all vertices of b that a does not share lie strictly on one side of a's plane: then they share only their common
/// vertices.
bool one_sided(const Triangle& a, const Triangle& b, const TriangleMesh& mesh) {
    const auto& x = mesh.vertices;
    int below = 0, above = 0, on = 0;
    for (const int v : b) {
        if (std::find(a.begin(), a.end(), v) != a.end()) continue;
        const int side = orient3d(x[a[0]], x[a[1]], x[a[2]], x[v]);
        below += side < 0;
        above += side > 0;
        on += side == 0;
    }
    return on == 0 && (below == 0) != (above == 0);
}

/// How two triangles of one mesh meet, apart from the vertices that they share. They are touching only where they share none.
Overlap overlap_within(const Surface& surface, int i, int j) {
    const TriangleMesh& mesh = surface.mesh;
    const Triangle &a = mesh.triangles[i], &b = mesh.triangles[j];
    const bool neighbours = share_a_vertex(a, b);
    if (neighbours && (one_sided(a, b, mesh) || one_sided(b, a, mesh))) return Overlap::disjoint;
    const Overlap overlap = classify(surface.triangles[i], surface.triangles[j]);
    return overlap == Overlap::touching && neighbours ? Overlap::disjoint : overlap;
}

}  // namespace

Certificate certify(const CertificateMesh& cloth, const CertificateMesh& obstacle, double distance_limit,
                    const std::atomic<bool>* cancel) {
    check_limit(distance_limit);
    const Cancel wish{cancel};
    wish.check();
    const Surface &cloth_surface = cloth.prepared(), &obstacle_surface = obstacle.prepared();
    Certificate result;
    const std::vector<bool> free = find_pairs(cloth_surface, obstacle_surface, wish, result);
    result.watertight = obstacle_surface.watertight();
    wish.check();
    if (result.watertight) measure_depth(cloth_surface.mesh, obstacle_surface, free, wish, result);
    const bool meet = !result.pairs.empty() || result.touching_pairs > 0;
    result.smallest_distance = meet ? 0.0 : smallest_distance(cloth_surface, obstacle_surface, distance_limit, wish);
    return result;
}

Certificate certify(const TriangleMesh& cloth, const TriangleMesh& obstacle, double distance_limit,
                    const std::atomic<bool>* cancel) {
    return certify(CertificateMesh(cloth, "certify: cloth"), CertificateMesh(obstacle, "certify: obstacle"), distance_limit,
                   cancel);
}

std::vector<double> surface_distances(const TriangleMesh& mesh, std::span<const Vec3> points, const std::atomic<bool>* cancel) {
    check_certifiable(mesh, "surface_distances: mesh");
    const Surface surface(mesh);
    const bool watertight = surface.watertight();
    const Box bounds = surface.tree.bounds();
    std::vector<double> distances;
    distances.reserve(points.size());
    const Cancel wish{cancel};
    for (const Vec3& x : points) {
        wish.check();
        if (!x.allFinite()) throw SceneError("surface_distances: a point is not finite");
        const bool inside = watertight && bounds.contains(x) && side_of(x, surface.triangles, surface.tree) == Side::inside;
        const double distance = distance_to_surface(x, surface);
        distances.push_back(inside ? -distance : distance);
    }
    return distances;
}

ClothCertificate certify_cloth(const CertificateMesh& cloth, std::span<const Stitch> stitches, const MeetingCloth& meeting,
                               const std::atomic<bool>* cancel) {
    const Surface& surface = cloth.prepared();
    if (!meeting.cloth.empty() && meeting.cloth.size() != surface.triangles.size())
        throw SceneError("certify_cloth: the cloths of " + std::to_string(meeting.cloth.size()) + " triangles for " +
                         std::to_string(surface.triangles.size()));
    const SewnTriangles sewn(surface.mesh, stitches);
    ClothCertificate result;
    const Cancel wish{cancel};
    const auto visit = [&](int i, int j) {
        if (i >= j || !meeting.meet(i, j)) return;
        const Overlap overlap = overlap_within(surface, i, j);
        if (overlap == Overlap::disjoint) return;
        const bool together = sewn.together(i, j), cross = overlap == Overlap::crossing;
        if (cross) (together ? result.at_seams : result.crossing).push_back({i, j});
        if (!cross && !together) result.touching.push_back({i, j});
    };
    surface.tree.walk_overlaps(surface.tree, visit, [&] { return wish.asked(); });
    wish.check();
    for (auto* pairs : {&result.crossing, &result.touching, &result.at_seams}) sort(*pairs);
    return result;
}

ClothCertificate certify_cloth(const TriangleMesh& cloth, std::span<const Stitch> stitches, const MeetingCloth& meeting,
                               const std::atomic<bool>* cancel) {
    return certify_cloth(CertificateMesh(cloth, "certify_cloth: cloth"), stitches, meeting, cancel);
}

CrossingSearch find_crossings(const TriangleMesh& mesh, long most_pairs, long most_tests) {
    check_certifiable(mesh, "find_crossings: mesh");
    const Surface surface(mesh);
    CrossingSearch result;
    long tests = 0;
    const auto enough = [&] { return tests >= most_tests || static_cast<long>(result.pairs.size()) >= most_pairs; };
    const auto visit = [&](int i, int j) {
        if (i >= j) return;
        if (enough()) {
            result.complete = false;
            return;
        }
        ++tests;
        if (overlap_within(surface, i, j) == Overlap::crossing) result.pairs.push_back({i, j});
    };
    surface.tree.walk_overlaps(surface.tree, visit, [&] { return !result.complete; });
    sort(result.pairs);
    return result;
}

std::vector<IntersectingPair> self_intersections(const TriangleMesh& mesh) {
    check_certifiable(mesh, "self_intersections: mesh");
    const Surface surface(mesh);
    std::vector<IntersectingPair> pairs;
    surface.tree.walk_overlaps(surface.tree, [&](int i, int j) {
        if (i >= j || share_a_vertex(mesh.triangles[i], mesh.triangles[j])) return;
        if (classify(surface.triangles[i], surface.triangles[j]) == Overlap::crossing) pairs.push_back({i, j});
    });
    sort(pairs);
    return pairs;
}

}  // namespace percale
