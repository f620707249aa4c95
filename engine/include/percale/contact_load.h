#pragma once

#include "percale/mesh.h"

namespace percale {

/// Force of an obstacle on a vertex of a cloth, the sum over their contacts by the vertex's weight in each, N.
struct ContactLoad {
    int vertex = -1;
    int obstacle = -1;             // its number: ObstacleId::index
    Vec3 normal = Vec3::Zero();    // what pushes the vertex off
    Vec3 friction = Vec3::Zero();  // along the surface

    Vec3 force() const { return normal + friction; }
};

}  // namespace percale
