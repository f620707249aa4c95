#include "scene_build.h"

#include <filesystem>

#include "event_script.h"
#include "mesh_import.h"
#include "percale/detectors.h"
#include "percale/error.h"
#include "scene_text.h"
#include "timeline.h"
#include "vertex_selection.h"

namespace percale::scenes {
namespace {

constexpr int sphere_level = 4;
constexpr int segments_around = 48;

// Runs a part of the build; what it finds wrong is told with the place of the cloth or obstacle in the scene file.
template <class Work>
auto at_place(const SourcePlace& place, const std::string& name, Work work) {
    try {
        return work();
    } catch (const SceneError& error) {
        const std::string what = error.what();
        fail_at(place, what.find("'" + name + "'") == std::string::npos ? "'" + name + "': " + what : what);
    }
}

TriangleMesh shape_mesh(const Shape& shape) {
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) return make_sphere(sphere->radius, sphere_level);
    if (const auto* box = std::get_if<BoxShape>(&shape)) return make_box(box->size);
    if (const auto* cylinder = std::get_if<CylinderShape>(&shape))
        return make_cylinder(cylinder->radius, cylinder->height, segments_around);
    if (const auto* capsule = std::get_if<CapsuleShape>(&shape))
        return make_capsule(capsule->radius, capsule->height, segments_around);
    if (const auto* plane = std::get_if<PlaneShape>(&shape)) return make_plane(plane->half_size);
    throw SceneError("an obstacle needs a mesh or a shape");
}

TriangleMesh rest_mesh(const Scene& scene, const ClothSpec& cloth) {
    TriangleMesh mesh =
        cloth.grid ? make_grid(cloth.grid->size[0], cloth.grid->size[1], cloth.grid->vertices[0], cloth.grid->vertices[1])
                   : import_mesh(path_beside(scene, cloth.mesh), cloth.unit);
    mesh.vertices = transform(cloth.pose, mesh.vertices);
    check_mesh(mesh, "cloth '" + cloth.name + "'", true);
    return mesh;
}

TriangleMesh obstacle_mesh(const Scene& scene, const ObstacleSpec& obstacle) {
    TriangleMesh mesh =
        obstacle.mesh.empty() ? shape_mesh(obstacle.shape) : import_mesh(path_beside(scene, obstacle.mesh), obstacle.unit);
    check_mesh(mesh, "obstacle '" + obstacle.name + "'", false);
    return mesh;
}

std::unique_ptr<ContactDetector> make_detector(const Scene& scene) {
    if (scene.obstacles.empty() && (scene.step.skip || scene.detector == Detector::none)) return nullptr;
    switch (scene.detector) {
        case Detector::fcl:
            return make_fcl_detector();
        case Detector::bullet:
            return make_bullet_detector();
        case Detector::brute_force:
            return make_brute_force_detector();
        case Detector::none:
            break;
    }
    const ObstacleSpec& obstacle = scene.obstacles.front();
    fail_at(obstacle.place,
            "obstacle '" + obstacle.name + "' needs a detector, but step.detector is none; valid: fcl, bullet, brute_force");
}

const Fabric& fabric_of(const Scene& scene, const ClothSpec& cloth) {
    const auto found = scene.fabrics.find(cloth.fabric);
    if (found == scene.fabrics.end()) throw SceneError("no fabric '" + cloth.fabric + "'");
    return found->second;
}

void add_cloth(BuiltScene& built, const ClothSpec& cloth) {
    TriangleMesh mesh = rest_mesh(built.scene, cloth);
    const ClothId id = built.simulation.add_cloth(mesh, fabric_of(built.scene, cloth), {}, cloth.name);
    for (const int vertex : select_vertices(cloth.pin, mesh, cloth.name)) built.simulation.pin(id, vertex);
    built.cloths.push_back(id);
    built.cloth_meshes.push_back(std::move(mesh));
}

void add_obstacle(BuiltScene& built, const ObstacleSpec& obstacle) {
    TriangleMesh mesh = obstacle_mesh(built.scene, obstacle);
    const ObstacleSettings settings{.friction = obstacle.friction, .name = obstacle.name};
    built.obstacles.push_back(built.simulation.add_obstacle(mesh, obstacle_pose_at(obstacle, 0.0), settings));
    built.obstacle_meshes.push_back(std::move(mesh));
}

}  // namespace

std::string path_beside(const Scene& scene, const std::string& path) {
    return (std::filesystem::path(scene.file).parent_path() / path).string();
}

BuiltScene build_scene(const Scene& scene) {
    const SourcePlace whole{.file = scene.file};
    std::unique_ptr<ContactDetector> detector = make_detector(scene);
    BuiltScene built{.scene = scene,
                     .simulation = at_place(whole, "step", [&] { return Simulation(scene.step, std::move(detector)); }),
                     .cloths = {},
                     .cloth_meshes = {},
                     .obstacles = {},
                     .obstacle_meshes = {}};
    for (const ClothSpec& cloth : scene.cloths) at_place(cloth.place, cloth.name, [&] { add_cloth(built, cloth); });
    for (const ObstacleSpec& obstacle : scene.obstacles)
        at_place(obstacle.place, obstacle.name, [&] { add_obstacle(built, obstacle); });
    script_events(scene, built.cloth_meshes);
    at_place(whole, "start", [&] { built.simulation.prepare(); });
    return built;
}

}  // namespace percale::scenes
