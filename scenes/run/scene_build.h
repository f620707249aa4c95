#pragma once

#include <string>
#include <vector>

#include "format/scene.h"
#include "percale/simulation.h"

namespace percale::scenes {

/// A scene with its meshes read and its simulation made.
struct BuiltScene {
    Scene scene;
    Simulation simulation;
    std::vector<ClothId> cloths;                // in the order of scene.cloths
    std::vector<TriangleMesh> cloth_meshes;     // rest meshes in world coordinates
    std::vector<ObstacleId> obstacles;          // in the order of scene.obstacles
    std::vector<TriangleMesh> obstacle_meshes;  // in their own coordinates, unit applied, pose not
    std::vector<std::string> warnings;          // what is not quite as the scene file says
};

/// The mesh of a cloth in its pose, in m, and of an obstacle with its unit applied, its pose not; not yet checked (check_mesh).
/// Throw SceneError for a file that cannot be read.
TriangleMesh rest_mesh(const Scene& scene, const ClothSpec& cloth);
TriangleMesh obstacle_mesh(const Scene& scene, const ObstacleSpec& obstacle);

/// Reads meshes, selects pins, makes the detector and the simulation, and checks the start (Simulation::prepare), which may move
/// cloth out of obstacles. Throws SceneError with the place of the cloth, obstacle, event or key in the scene file; where the
/// start is the trouble, StartRefused (start_fault.h). Where step.measure is automatic it becomes `all` if [expect] reads it.
BuiltScene build_scene(const Scene& given);

/// A path of the scene file as the program can open it: relative ones start at the scene file's folder.
std::string path_beside(const Scene& scene, const std::string& path);

}  // namespace percale::scenes
