#include "frames/ply_frames.h"

#include "frames/numbered_frames.h"
#include "meshes/ply_output.h"

namespace percale::scenes {

FrameFormat ply_frames() {
    const auto write = [](const std::string& path, const NumberedMesh& shape) { write_ply(path, shape.mesh, shape.fields); };
    return {.word = "ply",
            .sentence = "a binary PLY file for every mesh and frame, with output.fields",
            .endings = {".ply"},
            .holds_fields = true,
            .exact = true,
            .bytes =
                [](const MeshCounts& mesh) {
                    return FrameBytes{0.0, (24.0 + 4.0 * mesh.vertex_fields) * mesh.vertices +
                                               (13.0 + 4.0 * mesh.triangle_fields) * mesh.triangles};
                },
            .make = [=](const FrameCast& cast) { return numbered_frames(cast, ".ply", write); }};
}

}  // namespace percale::scenes
