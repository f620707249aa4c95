#pragma once

#include "substep.h"

namespace percale {

/// Where pins are at a fraction of the step, on the straight line from its start, m.
void set_targets(const Substep& substep, double fraction, Vec3Arrays& targets);

/// Motion of each obstacle over the step, seen from a fraction of it; none where no obstacle moves.
void set_obstacle_motions(const StepScene& scene, double fraction, std::vector<ObstacleMotion>& obstacle_motions);

/// Rest lengths of springs at a place of the substep, 0 ... 1: those of the start, or of the seams that are closing then. `list`
/// is storage for them.
std::span<const double> rest_lengths_at(const Substep& substep, double place, const StepState& start, std::vector<double>& list);

/// Sets end.rest_length, the rest lengths at the end of the substep. `list` is storage.
void set_rest_length(const Substep& substep, const StepState& start, std::vector<double>& list, ClothState& end);

/// Work of closing seams in a substep from one state to another, J: the weight of each stage times the energy that the change to
/// its length stores at the start, plus what the change from there stores at the end.
double seam_work(const Substep& substep, const StepState& start, const ClothState& end);

}  // namespace percale
