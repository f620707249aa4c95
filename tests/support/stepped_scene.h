#pragma once

#include <vector>

#include "percale/certify.h"
#include "percale/detectors.h"
#include "percale/percale.h"

// Whole simulations that are certified after every step.
namespace percale::test {

/// One cloth and some obstacles.
struct SteppedScene {
    Simulation simulation;
    ClothId cloth;
    TriangleMesh mesh;
    std::vector<TriangleMesh> obstacle_meshes = {};
    std::vector<ObstacleId> obstacles = {};

    SteppedScene(const TriangleMesh& sheet, const StepSettings& settings, double thickness = 5e-3)
        : simulation(settings, make_brute_force_detector()), mesh(sheet) {
        cloth = simulation.add_cloth(sheet,
                                     {.area_density = 0.2,
                                      .thickness = thickness,
                                      .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0},
                                      .spring_damping = 0.1},
                                     {}, "sheet");
    }
    void add(const TriangleMesh& obstacle, const std::string& name) {
        obstacles.push_back(simulation.add_obstacle(obstacle, {}, {.friction = 0.3, .name = name}));
        obstacle_meshes.push_back(obstacle);
    }
    /// Intersecting pairs and vertices inside, now.
    int faults() const {
        TriangleMesh here = mesh;
        const std::span<const Vec3> x = simulation.positions(cloth);
        here.vertices.assign(x.begin(), x.end());
        int found = 0;
        for (std::size_t k = 0; k < obstacles.size(); ++k) {
            TriangleMesh obstacle = obstacle_meshes[k];
            obstacle.vertices = transform(simulation.obstacle_pose(obstacles[k]), std::span<const Vec3>(obstacle.vertices));
            const Certificate certificate = certify(here, obstacle, 0.0);
            found += static_cast<int>(certificate.pairs.size()) + certificate.vertices_inside;
        }
        return found;
    }
};

}  // namespace percale::test
