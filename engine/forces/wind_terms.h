#pragma once

#include <vector>

#include "blocks.h"
#include "percale/mesh.h"

namespace percale {

/// One triangle in the air, as it lay when the stage began.
struct WindTriangle {
    Vec3 normal = Vec3::Zero();  // unit; zero if it has no area
    double area = 0.0;           // m^2
};

/// Air around all cloth during one stage.
struct StepWind {
    bool blows = false;                   // false: there is no air, nothing else is set
    Vec3 velocity = Vec3::Zero();         // m/s
    double density = 0.0;                 // kg/m^3
    std::vector<WindTriangle> triangles;  // in the order of the model's
};

/// What the wind leaves behind besides forces.
struct WindTerms {
    double power = 0.0;                  // W, of the air on the cloth
    double potential = 0.0;              // J, dt times the dissipation potential
    std::vector<SymmetricBlock> blocks;  // kg, -dt Jv of each vertex
};

}  // namespace percale
