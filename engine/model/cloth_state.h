#pragma once

#include <vector>

#include "percale/mesh.h"
#include "vec3_arrays.h"

namespace percale {

/// The stick anchor of a vertex: the point of the obstacle that lies `stretch` behind it.
struct StickAnchor {
    int vertex = -1, obstacle = -1;
    Vec3 stretch = Vec3::Zero();  // m, world, along the surface
};

/// A vertex that hit an obstacle, or cloth (obstacle -1), at a high speed.
struct Impact {
    int vertex = -1, obstacle = -1;
    double speed = 0.0;    // m/s, of approach; it fades once the vertex has been stopped
    bool stopped = false;  // and, where the obstacle has restitution, thrown back
};

/// Positions and velocities of the cloth, and the history of its springs and contacts.
struct ClothState {
    Vec3Arrays positions;                    // m
    Vec3Arrays velocities;                   // m/s
    std::vector<Vec3> points;                // positions again, one after the other, for detectors and callers
    std::vector<StickAnchor> stick_anchors;  // sorted by vertex and obstacle
    std::vector<Impact> impacts;             // sorted likewise
    /// m, of each spring of the network; empty: those of the model. Seams change theirs.
    std::vector<double> rest_length;
};

/// Copies positions to points.
inline void update_points(ClothState& state) { copy_out(state.positions, state.points); }

}  // namespace percale
