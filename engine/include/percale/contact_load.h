#pragma once

#include "percale/mesh.h"

namespace percale {

/// Force of an obstacle on a vertex of a cloth, the sum over their contacts by the vertex's weight in each, N. With the other
/// sign and at the same point it acts on the obstacle: Simulation::force_on and torque_on are the sums of that.
struct ContactLoad {
    int vertex = -1;
    int obstacle = -1;                   // its number: ObstacleId::index
    Vec3 normal = Vec3::Zero();          // what pushes the vertex off
    Vec3 friction = Vec3::Zero();        // along the surface
    Vec3 cloth_point = Vec3::Zero();     // m, world, where the force acts: the vertex, on the cloth's middle surface
    Vec3 obstacle_point = Vec3::Zero();  // m, world, on the obstacle: the mean of what presses, by normal force

    Vec3 force() const { return normal + friction; }
};

}  // namespace percale
