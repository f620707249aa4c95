#include "garment/cloth_warnings.h"

#include <algorithm>
#include <limits>

#include "common/text.h"
#include "meshes/mesh_facts.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

std::string density_warning(const std::string& name, double density) {
    const bool heavy = density > heaviest_cloth;
    const std::string other = short_number(heavy ? density / 1000.0 : 1000.0 * density);
    return "fabric '" + name + "': area_density " + short_number(density) + " kg/m^2 is too " + (heavy ? "heavy" : "light") +
           " for cloth (" + short_number(lightest_cloth) + " ... " + short_number(heaviest_cloth) + "); was " + other +
           " kg/m^2 meant?";
}

bool in_one_place(const TriangleMesh& a, const TriangleMesh& b, double thickness) {
    return std::ranges::equal(a.vertices, b.vertices,
                              [&](const Vec3& x, const Vec3& y) { return (x - y).squaredNorm() < thickness * thickness; });
}

bool is_filled(const Scene& scene, const ClothSpec& cloth) {
    const Fabric& fabric = scene.fabrics.at(cloth.fabric);
    return fabric.pressure || fabric.gas_volume;
}

/// Garments have rims and bodies are closed.
void warn_of_swapped(const Scene& scene, std::span<const TriangleMesh> starts, std::span<const TriangleMesh> obstacles,
                     std::vector<std::string>& warnings) {
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const ClothSpec& cloth = scene.cloths[i];
        if (cloth.mesh.empty() || is_filled(scene, cloth) || !is_watertight(starts[i])) continue;
        for (std::size_t k = 0; k < obstacles.size(); ++k) {
            if (scene.obstacles[k].mesh.empty() || is_watertight(joined_by_place(obstacles[k]).mesh)) continue;
            warnings.push_back("cloth '" + cloth.name + "': " + swapped_text("obstacle '" + scene.obstacles[k].name + "'"));
        }
    }
}

struct Box {
    Vec3 lowest = Vec3::Constant(std::numeric_limits<double>::infinity()), highest = -lowest;

    explicit Box(const TriangleMesh& mesh) {
        for (const Vec3& x : mesh.vertices) {
            lowest = lowest.cwiseMin(x);
            highest = highest.cwiseMax(x);
        }
    }
    void grow(double by) {
        lowest.array() -= by;
        highest.array() += by;
    }
    /// m along the axis where they are farthest apart; below 0 where they overlap.
    double gap(const Box& other) const {
        return std::max((lowest - other.highest).maxCoeff(), (other.lowest - highest).maxCoeff());
    }
};

/// Nothing but gravity moves anything.
bool only_falls(const Scene& scene) {
    const auto still = [](const ObstacleSpec& obstacle) {
        const bool endless = obstacle.mesh.empty() && std::holds_alternative<PlaneShape>(obstacle.shape);
        return !endless && obstacle.motion.empty() && !obstacle.spin && !obstacle.bends();
    };
    return scene.events.empty() && scene.seams.empty() && !scene.step.wind && std::ranges::all_of(scene.obstacles, still) &&
           std::ranges::all_of(scene.cloths, [&](const ClothSpec& cloth) {
               return cloth.pattern.empty() && cloth.rest.empty() && !is_filled(scene, cloth);
           });
}

/// Where cloth may come: as it starts and as far around as it is large, and from there along gravity, where no pin holds it.
Box reach_of(const Scene& scene, const ClothSpec& cloth, const TriangleMesh& start) {
    Box box(start);
    box.grow((box.highest - box.lowest).norm() + scene.fabrics.at(cloth.fabric).thickness);
    if (has_pins(cloth)) return box;
    for (int axis = 0; axis < 3; ++axis) {
        const double pull = scene.step.gravity[axis];
        if (pull < 0.0) box.lowest[axis] = -std::numeric_limits<double>::infinity();
        if (pull > 0.0) box.highest[axis] = std::numeric_limits<double>::infinity();
    }
    return box;
}

void warn_of_missing(const Scene& scene, std::span<const TriangleMesh> starts, std::span<const TriangleMesh> obstacles,
                     std::vector<std::string>& warnings) {
    if (starts.empty() || obstacles.empty() || !only_falls(scene)) return;
    double nearest = std::numeric_limits<double>::infinity();
    std::string pair;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const Box box(starts[i]), reach = reach_of(scene, scene.cloths[i], starts[i]);
        for (std::size_t k = 0; k < obstacles.size(); ++k) {
            const Box obstacle(obstacles[k]);
            if (reach.gap(obstacle) <= 0.0) return;
            if (box.gap(obstacle) >= nearest) continue;
            nearest = box.gap(obstacle);
            pair = "cloth '" + scene.cloths[i].name + "' starts " + short_number(nearest) + " m away from obstacle '" +
                   scene.obstacles[k].name + "'";
        }
    }
    warnings.push_back("no cloth can meet an obstacle from where it starts, " + pair +
                       "; is everything in its place, and in one unit?");
}

}  // namespace

std::string swapped_text(const std::string& obstacle) {
    return "it is a closed surface and " + obstacle + " is not: were their meshes swapped?";
}

std::vector<std::string> meeting_warnings(const Scene& scene, std::span<const TriangleMesh> starts,
                                          std::span<const TriangleMesh> obstacles) {
    std::vector<std::string> warnings;
    warn_of_swapped(scene, starts, obstacles, warnings);
    warn_of_missing(scene, starts, obstacles, warnings);
    return warnings;
}

std::vector<std::string> cloth_warnings(const Scene& scene, std::span<const TriangleMesh> starts) {
    std::vector<std::string> warnings;
    for (const auto& [name, fabric] : scene.fabrics) {
        const bool used = std::ranges::find(scene.cloths, name, &ClothSpec::fabric) != scene.cloths.end();
        const bool likely = fabric.area_density >= lightest_cloth && fabric.area_density <= heaviest_cloth;
        if (used && !likely) warnings.push_back(density_warning(name, fabric.area_density));
    }
    for (std::size_t b = 0; b < starts.size(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            const Fabric &first = scene.fabrics.at(scene.cloths[a].fabric), &second = scene.fabrics.at(scene.cloths[b].fabric);
            const double thickness = std::min(first.thickness, second.thickness);
            if ((first.self_contact && second.self_contact) || !in_one_place(starts[a], starts[b], thickness)) continue;
            warnings.push_back("cloths '" + scene.cloths[a].name + "' and '" + scene.cloths[b].name +
                               "' lie in one place and pass through each other; self_contact = true of their fabrics lets them "
                               "meet");
        }
    }
    return warnings;
}

}  // namespace percale::scenes
