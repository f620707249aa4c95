#pragma once

#include <vector>

#include "percale/mesh.h"
#include "vectors.h"

namespace percale {

/// What a vertex holds on to by friction: the point of the obstacle that lies `stretch` behind it.
struct Grip {
    int vertex = -1, obstacle = -1;
    Vec3 stretch = Vec3::Zero();  // m, world, along the surface
};

/// A vertex that came fast at an obstacle, or at cloth (obstacle -1).
struct Impact {
    int vertex = -1, obstacle = -1;
    double speed = 0.0;    // m/s, at which it came; once it has been stopped it fades
    bool stopped = false;  // and, where that has restitution, thrown back
};

/// Where the cloth is, and what its springs and contacts remember.
struct ClothState {
    Vectors positions;            // m
    Vectors velocities;           // m/s
    std::vector<Vec3> points;     // positions again, one after the other, for detectors and callers
    std::vector<Grip> grips;      // sorted by vertex and obstacle
    std::vector<Impact> impacts;  // sorted likewise
    /// m, of each spring of the network; empty: those of the model. Seams change theirs.
    std::vector<double> rest_length;
};

/// Copies positions to points.
inline void update_points(ClothState& state) { copy_out(state.positions, state.points); }

}  // namespace percale
