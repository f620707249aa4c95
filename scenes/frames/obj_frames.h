#pragma once

#include "frames/frame_format.h"

namespace percale::scenes {

/// Wavefront OBJ.
FrameFormat obj_frames();

}  // namespace percale::scenes
