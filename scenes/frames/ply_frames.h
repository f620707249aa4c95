#pragma once

#include "frames/frame_format.h"

namespace percale::scenes {

/// Binary PLY, with fields.
FrameFormat ply_frames();

}  // namespace percale::scenes
