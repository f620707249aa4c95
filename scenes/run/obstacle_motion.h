#pragma once

#include "format/scene.h"

namespace percale::scenes {

/// Pose of an obstacle at a time: motion keyframes (linear, shortest way, constant outside) replace the pose's translation and
/// rotation, the scale stays; a spin turns it about an axis of the world through the mesh's origin on top.
Pose obstacle_pose_at(const ObstacleSpec& obstacle, double time);

/// Whether an obstacle has more than one pose during a run.
bool obstacle_moves(const ObstacleSpec& obstacle);
/// Whether its frames differ: it moves, bends or gives way.
inline bool obstacle_changes(const ObstacleSpec& obstacle) { return obstacle_moves(obstacle) || obstacle.yields; }

}  // namespace percale::scenes
