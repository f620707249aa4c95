#pragma once

#include <memory>

#include "frames/frame_format.h"

namespace percale::scenes {

/// One mesh of one frame.
struct NumberedMesh {
    const TriangleMesh& mesh;
    const MeshFields& fields;
    const std::string& obj_file;  // of FrameCast
};

/// Writes one mesh to a path, whole or not at all.
using MeshWriter = std::function<void(const std::string& path, const NumberedMesh& mesh)>;

/// NAME_00012.obj
std::string numbered_name(const std::string& name, int index, const std::string& ending);

/// Frames as a file for every mesh and frame, frames/NAME_00012.obj and obstacles/NAME_00012.obj; an obstacle that rests has one,
/// with the number 0. `ending`: with the point.
std::unique_ptr<FrameEncoder> numbered_frames(const FrameCast& cast, const std::string& ending, MeshWriter write);

}  // namespace percale::scenes
