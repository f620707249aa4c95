#include "frames/ply_frames.h"

#include "frames/numbered_frames.h"
#include "meshes/ply_output.h"

namespace percale::scenes {

FrameFormat ply_frames() {
    return {.word = "ply",
            .sentence = "a binary PLY file for every mesh and frame, with output.fields",
            .endings = {".ply"},
            .holds_fields = true,
            .make = [](const FrameCast& cast) { return numbered_frames(cast, ".ply", write_ply); }};
}

}  // namespace percale::scenes
