#pragma once

#include <span>
#include <string>
#include <vector>

#include "frames/frame_format.h"

namespace percale::scenes {

/// The formats that frames can be written in.
std::span<const FrameFormat> frame_formats();

/// The word for a run that writes no frames.
inline constexpr const char* no_frames = "none";

/// All words that a scene file may say: no_frames, then those of the formats.
std::vector<std::string> frame_words();

/// "none: nothing; obj: a Wavefront OBJ file for every mesh and frame".
std::string frame_words_meaning();

}  // namespace percale::scenes
