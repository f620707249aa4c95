#pragma once

#include <memory>

#include "frames/frame_format.h"

namespace percale::scenes {

/// Frames as a file for every mesh and frame, frames/NAME_00012.obj and obstacles/NAME_00012.obj; an obstacle that rests has one,
/// with the number 0. `ending`: with the point; `write`: one mesh and its fields to a path, whole or not at all.
std::unique_ptr<FrameEncoder> numbered_frames(
    const FrameCast& cast, const std::string& ending,
    std::function<void(const std::string&, const TriangleMesh&, const MeshFields&)> write);

}  // namespace percale::scenes
