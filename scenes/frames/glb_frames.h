#pragma once

#include "frames/frame_format.h"

namespace percale::scenes {

/// One GLB file for the run (glTF 2.0): a node for every cloth and obstacle, what moves as morph targets, one for each frame
/// after the first, that one animation plays. Single precision.
FrameFormat glb_frames();

}  // namespace percale::scenes
