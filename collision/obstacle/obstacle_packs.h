#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "obstacle/obstacle_surface.h"
#include "obstacle/obstacle_tree.h"
#include "obstacle/pack_bounds.h"

namespace percale {

enum class PairKind : unsigned char { vertex_face, edge_edge, face_vertex };  // cloth feature first

/// Up to eight neighbouring obstacle features for one kind of pair.
struct FeaturePack {
    PairKind kind = PairKind::vertex_face;
    int count = 0;
    std::array<int, pack_lanes> feature{};  // triangles, edges or vertices; behind `count` the last one repeats
};

/// The data of a pack that the kernels read, for one place of the obstacle, contiguous in memory.
struct alignas(64) PlacedPack {
    double fraction = -1.0;      // of the step, where it was placed
    Vec3 centre = Vec3::Zero();  // m, world: the lanes' coordinates are about it
    float radius = 0.0F;         // m, no coordinate is larger
    float sharpness = 0.0F;      // 1/m, largest longest_over_area; of triangles alone
    float shortest_edge = 0.0F;  // m; of edges alone
    unsigned char all = 0;       // which lanes are used
    PackLanes lanes;

    void prefetch(PairKind kind) const {
        const char* line = reinterpret_cast<const char*>(this);
        const int lines = kind == PairKind::edge_edge ? 7 : kind == PairKind::vertex_face ? 6 : 5;
        for (int i = 0; i < lines; ++i) __builtin_prefetch(line + 64 * i);
    }
};

/// All features of a pack are below this plane and in this box during the whole step (m, world). It takes far less memory than
/// the pack.
struct alignas(64) PackHull {
    Vec3 normal = Vec3::Zero();  // unit
    double offset = 0.0;         // normal . x <= offset
    std::array<float, 3> low{}, high{};

    Box box() const { return {Vec3(low[0], low[1], low[2]), Vec3(high[0], high[1], high[2])}; }
};

/// Smallest height of points above the plane, m: a lower bound of the distance of their hull from everything below it.
inline double height_above(const PackHull& hull, std::span<const int> points, std::span<const Vec3> positions) {
    double lowest = hull.normal.dot(positions[points[0]]);
    for (const int point : points.subspan(1)) lowest = std::min(lowest, hull.normal.dot(positions[point]));
    return lowest - hull.offset;
}

/// Patches of sixteen neighbouring triangles with the edges and vertices they own that cloth can touch, in packs.
struct ObstaclePacks {
    std::vector<int> first;  // pack of each patch and kind, and one more: see packs_of
    std::vector<Box> box;    // of each patch, m, world, of the whole step
    std::vector<FeaturePack> packs;
    std::vector<int> patch_of_pack;
    std::vector<PackHull> hulls;  // of each pack
    std::vector<PlacedPack> placed;
    std::array<std::vector<int>, 3> place_of;  // by kind and feature: eight times the pack and the lane; -1 = in no pack

    std::size_t patch_count() const { return box.size(); }
    /// Numbers of the packs of one kind in a patch: from the first to before the second.
    std::pair<int, int> packs_of(int patch, PairKind kind) const {
        const int at = 3 * patch + static_cast<int>(kind);
        return {first[at], first[at + 1]};
    }
};

/// Longest edge over twice the area, 1/m: 1 over the height on it. Infinite for triangles too small to measure.
double longest_over_area(const Vec3& a, const Vec3& b, const Vec3& c);

/// Packs along a space-filling curve of the surface's vertices.
ObstaclePacks make_packs(const ObstacleSurface& surface);

/// Where the vertices are during a step, m, world.
struct VertexPaths {
    std::span<const Vec3> start, end;  // the same span if they rest

    bool rest() const { return start.data() == end.data(); }
    Vec3 at(int vertex, double fraction) const {
        return rest() ? start[vertex] : Vec3(start[vertex] + fraction * (end[vertex] - start[vertex]));
    }
};

/// Displacements of a patch's vertices during a step, m: all lie within `spread` of `mean`.
struct PatchMotion {
    Vec3 mean = Vec3::Zero();
    double spread = 0.0;
};

/// Sets the boxes of all patches for a step.
void set_boxes(ObstaclePacks& packs, const ObstacleSurface& surface, const VertexPaths& paths);

/// Sets the hulls of a patch's packs for a step.
void set_hulls(ObstaclePacks& packs, int patch, const ObstacleSurface& surface, const VertexPaths& paths);

PatchMotion motion_of(const ObstaclePacks& packs, int patch, const ObstacleSurface& surface, const VertexPaths& paths);

/// Whether the pack is where it is at a fraction of the step. Threads that see so may read it while others place other packs.
bool is_placed(const PlacedPack& placed, const VertexPaths& paths, double fraction);

/// The pack at a fraction of the step. Only obstacles at rest get normals and cones, because those of moving ones turn.
const PlacedPack& place(ObstaclePacks& packs, int pack, const ObstacleSurface& surface, const VertexPaths& paths,
                        double fraction);

}  // namespace percale
