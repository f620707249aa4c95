#include "frames/obj_frames.h"

#include "frames/numbered_frames.h"
#include "meshes/obj_file.h"

namespace percale::scenes {

FrameFormat obj_frames() {
    const auto write = [](const std::string& path, const TriangleMesh& mesh, const MeshFields&) {
        write_obj(path, mesh.vertices, mesh.triangles);
    };
    return {.word = "obj",
            .sentence = "a Wavefront OBJ file for every mesh and frame",
            .endings = {".obj"},
            .make = [=](const FrameCast& cast) { return numbered_frames(cast, ".obj", write); }};
}

}  // namespace percale::scenes
