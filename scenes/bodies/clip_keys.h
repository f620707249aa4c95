#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/model.h"

namespace percale::scenes {

/// A node's transform to its parent at a tick: translation T, rotation R, scale S of its tracks, x -> T + R S x; without keys 0,
/// no turn, 1. Between keys linear, rotations the shortest way at a constant rate; constant; or a cubic Hermite spline; constant
/// outside.
Eigen::Matrix4d node_transform(const ModelChannel& channel, double tick);

/// How much of each morph target a mesh takes at a tick, likewise.
std::vector<double> morph_weights(const ModelMorphs& morphs, double tick);

/// The time of the last key of a clip, in ticks.
double last_key(const ModelClip& clip);

}  // namespace percale::scenes
