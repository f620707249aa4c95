#include "garment/meeting_warnings.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

#include "common/bounds.h"
#include "common/scene_file_error.h"
#include "common/text.h"
#include "meshes/mesh_facts.h"

namespace percale::scenes {
namespace {

/// Garments have rims and bodies are closed.
void warn_of_swapped(const Scene& scene, std::span<const TriangleMesh> starts, std::span<const TriangleMesh> obstacles,
                     std::vector<Finding>& warnings) {
    const auto is_closed = [&](const ClothSpec& cloth) {
        return !cloth.mesh.empty() && !scene.is_filled(cloth) && is_watertight(starts[&cloth - scene.cloths.data()]);
    };
    const auto cloth = std::ranges::find_if(scene.cloths, is_closed);
    if (cloth == scene.cloths.end()) return;
    const ObstacleSpec* open = nullptr;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        if (scene.obstacles[k].mesh.empty()) continue;
        if (is_watertight(joined_by_place(obstacles[k]).mesh)) return;  // there is a body
        open = &scene.obstacles[k];
    }
    if (open == nullptr) return;
    warnings.push_back(
        finding("swapped", cloth->place, "cloth '" + cloth->name + "': " + swapped_text("obstacle '" + open->name + "'")));
}

/// The centroid of the triangles' areas, and so of the mass.
Vec3 middle_of(const TriangleMesh& mesh) {
    Vec3 sum = Vec3::Zero();
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        const double own = (b - a).cross(c - a).norm();
        sum += own * (a + b + c) / 3.0;
        area += own;
    }
    return sum / area;
}

using Neighbours = std::vector<std::vector<int>>;

/// The lengths of the shortest paths along edges from one vertex to each (Dijkstra 1959), m; infinite where there is none.
std::vector<double> paths_from(int from, const TriangleMesh& mesh, const Neighbours& next) {
    std::vector<double> path(mesh.vertices.size(), std::numeric_limits<double>::infinity());
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open;
    path[from] = 0.0;
    open.push({0.0, from});
    while (!open.empty()) {
        const auto [length, v] = open.top();
        open.pop();
        if (length > path[v]) continue;
        for (const int w : next[v]) {
            const double by_v = length + (mesh.vertices[v] - mesh.vertices[w]).norm();
            if (by_v >= path[w]) continue;
            path[w] = by_v;
            open.push({by_v, w});
        }
    }
    return path;
}

/// An upper bound of the distance between any two vertices, m, however the cloth unfolds: twice the longest of the shortest paths
/// along edges from a vertex in its middle. It is infinite for cloth of several pieces.
double unfolded_size(const TriangleMesh& mesh) {
    Neighbours next(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            next[t[k]].push_back(t[(k + 1) % 3]);
            next[t[(k + 1) % 3]].push_back(t[k]);
        }
    }
    const auto farthest = [](const std::vector<double>& path) {
        return static_cast<int>(std::ranges::max_element(path) - path.begin());
    };
    const int one = farthest(paths_from(0, mesh, next));
    const std::vector<double> from_one = paths_from(one, mesh, next), from_other = paths_from(farthest(from_one), mesh, next);
    int middle = 0;
    for (std::size_t v = 0; v < next.size(); ++v)
        if (std::max(from_one[v], from_other[v]) < std::max(from_one[middle], from_other[middle])) middle = static_cast<int>(v);
    return 2.0 * std::ranges::max(paths_from(middle, mesh, next));
}

/// Whether nothing but gravity moves anything, and no cloth moves another.
bool only_falls(const Scene& scene) {
    const auto still = [](const ObstacleSpec& obstacle) {
        const bool endless = obstacle.mesh.empty() && std::holds_alternative<PlaneShape>(obstacle.shape);
        return !endless && obstacle.motion.empty() && !obstacle.spin && !obstacle.bends();
    };
    const bool alone = scene.cloths.size() == 1 || scene.cloth_that_meets_cloth() == nullptr;
    return alone && scene.events.empty() && scene.seams.empty() && !scene.step.wind &&
           std::ranges::all_of(scene.obstacles, still) && std::ranges::all_of(scene.cloths, [&](const ClothSpec& cloth) {
               return cloth.pattern.empty() && cloth.rest.empty() && !scene.is_filled(cloth);
           });
}

/// The box that cloth of that size may reach: as far around its start if a pin holds it, else around its middle, which falls
/// along gravity.
Bounds reach_of(const Scene& scene, const ClothSpec& cloth, const TriangleMesh& start, double size) {
    Bounds box(start.vertices);
    const double thickness = scene.fabrics.at(cloth.fabric).thickness;
    if (has_pins(cloth)) {
        box.grow(size + thickness);
        return box;
    }
    const Vec3 middle = middle_of(start);
    Bounds around({&middle, 1});
    around.grow(size + thickness);
    box.lowest = box.lowest.cwiseMin(around.lowest);
    box.highest = box.highest.cwiseMax(around.highest);
    for (int axis = 0; axis < 3; ++axis) {
        const double pull = scene.step.gravity[axis];
        if (pull < 0.0) box.lowest[axis] = -std::numeric_limits<double>::infinity();
        if (pull > 0.0) box.highest[axis] = std::numeric_limits<double>::infinity();
    }
    return box;
}

void warn_of_missing(const Scene& scene, std::span<const TriangleMesh> starts, std::span<const TriangleMesh> obstacles,
                     std::vector<Finding>& warnings) {
    if (starts.empty() || obstacles.empty() || !only_falls(scene)) return;
    double nearest = std::numeric_limits<double>::infinity();
    std::string pair;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const ClothSpec& cloth = scene.cloths[i];
        const auto gap_to = [&](const TriangleMesh& obstacle, double size) {
            return reach_of(scene, cloth, starts[i], size).gap(Bounds(obstacle.vertices));
        };
        const auto meets = [&](double size) {
            return std::ranges::any_of(obstacles, [&](const TriangleMesh& obstacle) { return gap_to(obstacle, size) <= 0.0; });
        };
        if (meets(0.0) || meets(unfolded_size(starts[i]))) return;
        for (std::size_t k = 0; k < obstacles.size(); ++k) {
            const double gap = gap_to(obstacles[k], 0.0);
            if (gap >= nearest) continue;
            nearest = gap;
            pair =
                "cloth '" + cloth.name + "' stays " + short_number(gap) + " m beside obstacle '" + scene.obstacles[k].name + "'";
        }
    }
    warnings.push_back(finding("out_of_reach", {scene.file}, "no cloth can meet an obstacle from where it starts: " + pair,
                               "move it there by pose.translation, or say the unit of its mesh"));
}

}  // namespace

std::string swapped_text(const std::string& obstacle) {
    return "it is a closed surface and " + obstacle + " is not: were their meshes swapped?";
}

std::vector<Finding> meeting_warnings(const Scene& scene, std::span<const TriangleMesh> starts,
                                      std::span<const TriangleMesh> obstacles) {
    std::vector<Finding> warnings;
    warn_of_swapped(scene, starts, obstacles, warnings);
    warn_of_missing(scene, starts, obstacles, warnings);
    return warnings;
}

}  // namespace percale::scenes
