#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/model.h"

namespace percale::scenes {

/// A node's transform to its parent at a tick: translation T, rotation R, scale S of its tracks, x -> T + R S x; a track without
/// keys is 0, no turn or 1. Between keys a track is linear (rotations turn the shortest way at a constant rate), constant or a
/// cubic Hermite spline; outside the keys it is constant.
Eigen::Matrix4d node_transform(const ModelChannel& channel, double tick);

/// The weight of each morph target of a mesh at a tick, interpolated likewise.
std::vector<double> morph_weights(const ModelMorphs& morphs, double tick);

/// The time of the last key of a clip, in ticks.
double last_key(const ModelClip& clip);

}  // namespace percale::scenes
