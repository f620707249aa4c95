#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "percale/mesh.h"
#include "untangle/untangle_obstacle.h"

namespace percale {

/// Input of untangling: all cloths of a simulation and their connectivity.
struct TangledCloth {
    std::span<const Triangle> triangles;
    std::span<const double> thickness;  // m, of each vertex
    std::span<const double> free;       // 0: stays
    std::vector<std::vector<int>> neighbours;
    const std::atomic<bool>* cancel = nullptr;  // true: the search for a solution ends

    int vertex_count() const { return static_cast<int>(thickness.size()); }
};

TangledCloth make_tangled_cloth(std::span<const Triangle> triangles, std::span<const double> thickness,
                                std::span<const double> free, const std::atomic<bool>* cancel = nullptr);

/// For each vertex an obstacle that it conflicts with, -1 where there is none: the vertex is inside, or a triangle of it crosses
/// or touches the obstacle without a corner inside. Triangles with a vertex for which `moved` is true also conflict where they
/// come nearer than a quarter of the thickness. `moved` may be empty.
std::vector<int> find_conflicts(const TangledCloth& cloth, std::span<const SolidObstacle> obstacles,
                                std::span<const Vec3> positions, const std::vector<bool>& moved);

/// Vertices behind an open obstacle: where it cuts a piece of cloth, all but those on the side with most vertices. -1 or the
/// obstacle.
std::vector<int> find_behind(const TangledCloth& cloth, std::span<const SolidObstacle> obstacles,
                             std::span<const Vec3> positions);

}  // namespace percale
