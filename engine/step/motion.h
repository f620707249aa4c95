#pragma once

#include "model/cloth_state.h"
#include "plan/scene.h"

namespace percale {

/// Tells the detector where the obstacle of a number is at the ends of the coming step.
void tell_obstacle(const ObstacleState& obstacle, int number, ContactDetector& detector);

/// Tells the detector where obstacles are at the ends of the coming step, where it does not know it yet.
void tell_obstacles(StepScene& scene);

/// After a good step: obstacles stay where they arrived.
void finish_motion(StepScene& scene);

/// Into how many equal parts the coming step is divided, and what asks for them.
struct MotionParts {
    int count = 1;
    int obstacle = -1;    // the one that asks for most, or
    int vertex = -1;      // the pinned vertex that does
    double travel = 0.0;  // m: how far it goes beside the cloth that it meets, or that it holds
    bool jumps = false;   // so far that it may have jumped; what turns or bends does not
};

/// No obstacle that may meet a cloth turns by more than 15 degrees in a part, as its vertices go straight there, nor moves by
/// more than 20 thicknesses of that cloth beside its mean motion, so that the cloth can follow. No pin of cloth with contact
/// moves by more than 80.
MotionParts motion_parts(const StepScene& scene, const ClothState& state);

}  // namespace percale
