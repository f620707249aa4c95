#pragma once

#include "run/scene_build.h"

namespace percale::scenes {

/// What an obstacle does between two times.
struct MotionAmount {
    double angle = 0.0;  // rad, by keyframes and spin together; no smaller than the turn of its pose
    double path = 0.0;   // m, of the mesh's origin along the keyframes
};
MotionAmount motion_between(const ObstacleSpec& obstacle, double from, double to);

/// Into how many equal parts the coming step, from now on and `dt` long, is divided.
/// No obstacle turns by more than 15 degrees in a part: within one its vertices run on chords, which then lie at most 0.9 % of
/// their distance from the axis inside the arcs. And no obstacle near a cloth moves by more than four thicknesses relative
/// to the mean motion of that cloth, so that the cloth can follow. At most 100000.
int motion_parts(const BuiltScene& built, double dt);

}  // namespace percale::scenes
