#pragma once

#include "percale/mesh.h"

namespace percale::scenes {

/// A square plate with rows of four-sided spikes; all lengths in m.
struct SpikeBed {
    double width = 0.6;
    int count = 5;            // spikes along a side, 1 ... 100
    double height = 0.15;     // of the tips above the plate
    double base = 0.06;       // side of a spike's foot; less than width / count
    double thickness = 0.02;  // of the plate
};

/// The bed as a watertight mesh, normals outward: top of the plate at y = 0, centred in x and z, tips at y = height.
/// Throws SceneError naming the field and its range.
TriangleMesh make_spikes(const SpikeBed& bed = {});

}  // namespace percale::scenes
