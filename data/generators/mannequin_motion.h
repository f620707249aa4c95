#pragma once

#include "generators/mannequin_rig.h"

// How the mannequin moves.
namespace percale::scenes {

/// s, of two steps; m/s, at which the floor, and a foot that stands, passes backwards under the walking mannequin.
inline constexpr double walk_period = 1.1, walk_speed = 0.95;

/// s, from the first to the last pose of the wave.
inline constexpr double wave_duration = 2.5;

/// Walking in place, facing +z. The left heel comes down at phase 0, the right one at 0.5; any finite phase, with the period 1. A
/// foot stands for three fifths of the period and moves at (0, 0, -walk_speed) meanwhile, so whoever moves the mannequin by
/// walk_speed along z has feet that do not slide.
MannequinPose walk_pose(double phase);

/// The right arm goes up, the forearm waves three times, and the arm comes down again. s; before 0 and from wave_duration on the
/// pose in which the mesh was made.
MannequinPose wave_pose(double time);

}  // namespace percale::scenes
