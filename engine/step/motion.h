#pragma once

#include "model/cloth_state.h"
#include "plan/scene.h"

namespace percale {

/// Passes to the detector where obstacles are at the ends of the coming step, where it does not know it yet.
void report_obstacles(StepScene& scene);

/// Called after a good step: obstacles stay where they arrived.
void finish_motion(StepScene& scene);

/// Into how many equal parts the coming step is divided, and what determines it.
struct MotionParts {
    int count = 1;
    int obstacle = -1;    // the one that needs the most parts, or
    int vertex = -1;      // the pinned vertex that does
    double travel = 0.0;  // m: how far it moves relative to the cloth that it meets, or that it holds
    bool jumps = false;   // so far that it may have jumped; rotation and deformation do not count
};

/// No obstacle that may meet a cloth turns by more than 15 degrees in a part, as its vertices move straight, nor moves by more
/// than 20 thicknesses of that cloth relative to its mean motion, so that the cloth can follow. No pin of cloth with contact
/// moves by more than 80.
MotionParts motion_parts(const StepScene& scene, const ClothState& state);

}  // namespace percale
