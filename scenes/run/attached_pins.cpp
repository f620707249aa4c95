#include "run/attached_pins.h"

#include <algorithm>

#include "common/nearest_name.h"
#include "common/scene_file_error.h"
#include "common/text.h"
#include "garment/vertex_selection.h"
#include "percale/error.h"
#include "run/obstacle_motion.h"

namespace percale::scenes {
namespace {

int obstacle_number(const Scene& scene, const ClothSpec& cloth, const std::string& name) {
    std::vector<std::string> names;
    for (const ObstacleSpec& obstacle : scene.obstacles) names.push_back(obstacle.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<int>(found - names.begin());
    fail_at(cloth.pin_place, "pin.to: no obstacle '" + name + "'" + suggestion(name, names));
}

}  // namespace

std::vector<AttachedPin> attached_pins(const Scene& scene, std::span<const TriangleMesh> cloth_meshes,
                                       std::span<const TriangleMesh> obstacle_meshes) {
    std::vector<AttachedPin> pins;
    for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
        const ClothSpec& cloth = scene.cloths[i];
        const auto* box = std::get_if<VertexBox>(&cloth.pin);
        if (box == nullptr || box->to.empty()) continue;
        const int obstacle = obstacle_number(scene, cloth, box->to);
        const ObstacleSpec& body = scene.obstacles[static_cast<std::size_t>(obstacle)];
        const Pose start = obstacle_pose_at(body, 0.0);
        const std::vector<int> vertices = select_vertices(cloth.pin, cloth_meshes[i], cloth.name);
        std::vector<Vec3> places;
        for (const int vertex : vertices)
            places.push_back(inverse_transform(start, cloth_meshes[i].vertices[static_cast<std::size_t>(vertex)]));
        std::vector<SurfacePoint> on;
        if (body.bends())
            at_place(cloth.pin_place, "pin.to: '" + body.name + "': ", [&] {
                on = attach(obstacle_meshes[static_cast<std::size_t>(obstacle)], places);
            });
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            pins.push_back({static_cast<int>(i), vertices[k], obstacle, places[k]});
            if (body.bends()) pins.back().on = on[k];
        }
    }
    return pins;
}

Vec3 place_at(const AttachedPin& pin, const Scene& scene, std::span<const Vec3> shape, double time) {
    Vec3 place = pin.place;
    try {
        if (pin.on) place = place_of(*pin.on, shape);
    } catch (const SceneError& error) {
        throw SceneError("vertex " + std::to_string(pin.vertex) + " of '" +
                         scene.cloths[static_cast<std::size_t>(pin.cloth)].name + "', pinned to '" +
                         scene.obstacles[static_cast<std::size_t>(pin.obstacle)].name + "', at " + number_text(time) +
                         " s: " + error.what());
    }
    return transform(obstacle_pose_at(scene.obstacles[static_cast<std::size_t>(pin.obstacle)], time), place);
}

}  // namespace percale::scenes
