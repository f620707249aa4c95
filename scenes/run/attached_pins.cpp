#include "run/attached_pins.h"

#include <algorithm>

#include "common/nearest_name.h"
#include "common/scene_file_error.h"
#include "garment/vertex_selection.h"
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

/// What a pose takes to the point.
Vec3 before(const Pose& pose, const Vec3& point) {
    const Rotation& q = pose.rotation;
    const Pose back{.translation = Vec3::Zero(), .rotation = {q.w, -q.x, -q.y, -q.z}, .scale = 1.0 / pose.scale};
    return transform(back, Vec3(point - pose.translation));
}

}  // namespace

std::vector<AttachedPin> attached_pins(const Scene& scene, std::span<const TriangleMesh> cloth_meshes) {
    std::vector<AttachedPin> pins;
    for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
        const ClothSpec& cloth = scene.cloths[i];
        const auto* box = std::get_if<VertexBox>(&cloth.pin);
        if (box == nullptr || box->to.empty()) continue;
        const int obstacle = obstacle_number(scene, cloth, box->to);
        if (scene.obstacles[static_cast<std::size_t>(obstacle)].frames) {
            fail_at(cloth.pin_place,
                    "pin.to: '" + box->to + "' changes its shape (frames); pins keep their place on rigid obstacles");
        }
        const Pose start = obstacle_pose_at(scene.obstacles[static_cast<std::size_t>(obstacle)], 0.0);
        for (const int vertex : select_vertices(cloth.pin, cloth_meshes[i], cloth.name)) {
            const Vec3& x = cloth_meshes[i].vertices[static_cast<std::size_t>(vertex)];
            pins.push_back({static_cast<int>(i), vertex, obstacle, before(start, x)});
        }
    }
    return pins;
}

Vec3 place_at(const AttachedPin& pin, const Scene& scene, double time) {
    return transform(obstacle_pose_at(scene.obstacles[static_cast<std::size_t>(pin.obstacle)], time), pin.place);
}

}  // namespace percale::scenes
