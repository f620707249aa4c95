#pragma once

#include "frames/frame_format.h"

namespace percale::scenes {

/// A point cache for every cloth and every obstacle that moves, as 3ds Max (PC2) and LightWave (MDD) have them: the vertices of
/// all frames in single precision, to be played on a mesh, which is written beside it as NAME.mesh.obj. PointCache describes the
/// layout of the bytes.
FrameFormat pc2_frames();
FrameFormat mdd_frames();

}  // namespace percale::scenes
