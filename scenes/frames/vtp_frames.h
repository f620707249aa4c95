#pragma once

#include "frames/frame_format.h"

namespace percale::scenes {

/// VTK's polygon data in XML, binary and in double precision, with fields, and a collection with the times of frames.
FrameFormat vtp_frames();

}  // namespace percale::scenes
