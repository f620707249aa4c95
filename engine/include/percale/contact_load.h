#pragma once

#include "percale/mesh.h"

namespace percale {

/// Force of an obstacle on a vertex of a cloth, the sum over their contacts by the vertex's weight in each, N. The opposite force
/// acts on the obstacle at the same point: Simulation::force_on and torque_on are sums of these.
struct ContactLoad {
    int vertex = -1;
    int obstacle = -1;                   // its number: ObstacleId::index
    Vec3 normal = Vec3::Zero();          // normal part, pushes the vertex off
    Vec3 friction = Vec3::Zero();        // tangential part
    Vec3 cloth_point = Vec3::Zero();     // m, world, where the force acts: the vertex, on the cloth's middle surface
    Vec3 obstacle_point = Vec3::Zero();  // m, world, on the obstacle: mean of the contact points, weighted by normal force

    Vec3 force() const { return normal + friction; }
};

}  // namespace percale
