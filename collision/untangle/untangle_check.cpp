#include "untangle/untangle_check.h"

#include <algorithm>

#include "certificate/triangle_gap.h"
#include "certificate/triangle_overlap.h"
#include "geometry/disjoint_sets.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Fraction of h that moved cloth keeps from obstacles. Less than clamp_floor would start the run within the floor of clamps.
/// Towards 1: narrow places have no exit.
constexpr double untangled_gap = 0.25;

using certificate::BoxTree;
using certificate::Corners;
using certificate::Overlap;

Corners corners(std::span<const Vec3> x, const Triangle& t) { return {x[t[0]], x[t[1]], x[t[2]]}; }

/// The cloth's triangles near obstacles, in a tree, their boxes grown by the gap that they have to keep.
struct PlacedCloth {
    std::vector<int> number;  // of each triangle among the cloth's
    std::vector<Corners> triangles;
    std::vector<double> gap;
    std::vector<certificate::Slab> slab;  // of triangles with a gap
    BoxTree tree;

    /// Whether a triangle is nearer than its gap to one that it does not meet; a bound excludes most.
    bool is_too_near(int i, const Corners& other) const {
        const double surely_far = gap[i] * (1.0 + tolerances::bound_slack);
        if (certificate::triangle_separation(triangles[i], slab[i], other, surely_far) > surely_far) return false;
        return certificate::triangle_distance(triangles[i], other) < gap[i];
    }
};

/// Leaves out triangles that are near no obstacle: they meet none, are too near to none and have no corner inside.
PlacedCloth place(const TangledCloth& cloth, std::span<const Vec3> x, const std::vector<bool>& moved,
                  std::span<const SolidObstacle> obstacles) {
    std::vector<int> numbers;
    std::vector<Corners> triangles;
    std::vector<double> gaps;
    std::vector<certificate::Slab> slabs;
    std::vector<certificate::Box> boxes;
    for (std::size_t i = 0; i < cloth.triangles.size(); ++i) {
        const Triangle& t = cloth.triangles[i];
        const Corners at = corners(x, t);
        const bool any = !moved.empty() && (moved[t[0]] || moved[t[1]] || moved[t[2]]);
        const double gap = any ? untangled_gap * cloth.thickness[t[0]] : 0.0;
        certificate::Box box = certificate::box_of(at);
        box.low.array() -= gap;
        box.high.array() += gap;
        const auto is_about = [&](const SolidObstacle& obstacle) { return certificate::overlap(box, obstacle.tree().bounds()); };
        if (std::none_of(obstacles.begin(), obstacles.end(), is_about)) continue;
        numbers.push_back(static_cast<int>(i));
        triangles.push_back(at);
        gaps.push_back(gap);
        slabs.push_back(any ? certificate::slab_of(at) : certificate::Slab{});
        boxes.push_back(box);
    }
    BoxTree tree{std::span<const certificate::Box>(boxes)};
    return {std::move(numbers), std::move(triangles), std::move(gaps), std::move(slabs), std::move(tree)};
}

/// The cloth triangles near an obstacle's box: all that can meet it, come too near or have a corner inside.
std::vector<int> triangles_around(const PlacedCloth& placed, const SolidObstacle& obstacle) {
    const certificate::Box bounds = obstacle.tree().bounds();
    std::vector<int> around;
    placed.tree.walk([&](const certificate::Box& box) { return certificate::overlap(box, bounds); },
                     [&](int item) { around.push_back(placed.number[item]); });
    return around;
}

/// How each cloth triangle meets an obstacle.
struct Meetings {
    std::vector<bool> meets;     // shares a point with it
    std::vector<bool> too_near;  // or comes nearer than its gap
};

Meetings find_meetings(const PlacedCloth& placed, const SolidObstacle& obstacle, std::size_t triangles) {
    Meetings found{std::vector<bool>(triangles), std::vector<bool>(triangles)};
    placed.tree.walk_overlaps(obstacle.tree(), [&](int item, int j) {
        const Corners &a = placed.triangles[item], &b = obstacle.triangles()[j];
        const int i = placed.number[item];
        if (found.meets[i]) return;
        if (certificate::classify(a, b) != Overlap::disjoint)
            found.meets[i] = found.too_near[i] = true;
        else if (!found.too_near[i] && placed.gap[item] > 0.0)
            found.too_near[i] = placed.is_too_near(item, b);
    });
    return found;
}

/// Vertices joined by triangles that do not meet the obstacle lie on one side of it: one of them is tested for all. Every vertex
/// of cloth belongs to a triangle.
std::vector<bool> find_inside(const TangledCloth& cloth, const SolidObstacle& obstacle, std::span<const Vec3> x,
                              std::span<const int> around, const std::vector<bool>& meets) {
    std::vector<bool> inside(x.size()), asked(x.size());
    if (!obstacle.watertight()) return inside;
    DisjointSets groups(cloth.vertex_count());
    for (const int i : around) {
        const Triangle& t = cloth.triangles[i];
        if (meets[i]) continue;
        groups.join(t[0], t[1]);
        groups.join(t[1], t[2]);
    }
    for (const int i : around) {
        for (const int v : cloth.triangles[i]) {
            const int first = groups.of(v);
            if (!asked[first]) inside[first] = obstacle.inside(x[first]);
            asked[first] = true;
            inside[v] = inside[first];
        }
    }
    return inside;
}

bool is_cut(const Vec3& a, const Vec3& b, const SolidObstacle& obstacle) {
    const Corners edge{a, b, b};
    const certificate::Box box = certificate::box_of(edge);
    bool cut = false;
    obstacle.tree().walk(
        [&](const certificate::Box& other) { return !cut && certificate::overlap(box, other); },
        [&](int item) { cut = cut || certificate::classify(edge, obstacle.triangles()[item]) != Overlap::disjoint; });
    return cut;
}

/// The side with most vertices in every connected piece of cloth; the number of the side is at the index of the piece.
std::vector<int> largest_sides(DisjointSets& sides, DisjointSets& pieces, int count) {
    std::vector<int> size(count, 0), largest(count, -1);
    for (int v = 0; v < count; ++v) ++size[sides.of(v)];
    for (int v = 0; v < count; ++v) {
        int& best = largest[pieces.of(v)];
        if (best < 0 || size[sides.of(v)] > size[best]) best = sides.of(v);
    }
    return largest;
}

void mark_behind(const TangledCloth& cloth, const SolidObstacle& obstacle, int number, std::span<const Vec3> x,
                 std::vector<int>& behind) {
    const Meetings meetings = find_meetings(place(cloth, x, {}, {&obstacle, 1}), obstacle, cloth.triangles.size());
    if (std::find(meetings.meets.begin(), meetings.meets.end(), true) == meetings.meets.end()) return;
    DisjointSets sides(cloth.vertex_count()), pieces(cloth.vertex_count());
    for (std::size_t i = 0; i < cloth.triangles.size(); ++i) {
        const Triangle& t = cloth.triangles[i];
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            pieces.join(a, b);
            if (!meetings.meets[i] || !is_cut(x[a], x[b], obstacle)) sides.join(a, b);
        }
    }
    const std::vector<int> largest = largest_sides(sides, pieces, cloth.vertex_count());
    for (int v = 0; v < cloth.vertex_count(); ++v) {
        if (largest[pieces.of(v)] != sides.of(v)) behind[v] = number;
    }
}

}  // namespace

TangledCloth make_tangled_cloth(std::span<const Triangle> triangles, std::span<const double> thickness,
                                std::span<const double> free, const std::atomic<bool>* cancel) {
    TangledCloth cloth{.triangles = triangles, .thickness = thickness, .free = free, .neighbours = {}, .cancel = cancel};
    cloth.neighbours.resize(thickness.size());
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            cloth.neighbours[t[k]].push_back(t[(k + 1) % 3]);
            cloth.neighbours[t[k]].push_back(t[(k + 2) % 3]);
        }
    }
    for (std::vector<int>& ring : cloth.neighbours) {
        std::sort(ring.begin(), ring.end());
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    }
    return cloth;
}

std::vector<int> find_conflicts(const TangledCloth& cloth, std::span<const SolidObstacle> obstacles,
                                std::span<const Vec3> positions, const std::vector<bool>& moved) {
    const PlacedCloth placed = place(cloth, positions, moved, obstacles);
    std::vector<int> conflict(positions.size(), -1);
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        const std::vector<int> around = triangles_around(placed, obstacles[k]);
        if (around.empty()) continue;
        const Meetings meetings = find_meetings(placed, obstacles[k], cloth.triangles.size());
        const std::vector<bool> inside = find_inside(cloth, obstacles[k], positions, around, meetings.meets);
        const auto mark = [&](const Triangle& t, bool pierced) {
            for (const int v : t) {
                if (pierced || inside[v]) conflict[v] = static_cast<int>(k);
            }
        };
        for (const int i : around) {
            const Triangle& t = cloth.triangles[i];
            mark(t, meetings.too_near[i] && !inside[t[0]] && !inside[t[1]] && !inside[t[2]]);
        }
    }
    return conflict;
}

std::vector<int> find_behind(const TangledCloth& cloth, std::span<const SolidObstacle> obstacles,
                             std::span<const Vec3> positions) {
    std::vector<int> behind(positions.size(), -1);
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        if (!obstacles[k].watertight()) mark_behind(cloth, obstacles[k], static_cast<int>(k), positions, behind);
    }
    return behind;
}

}  // namespace percale
