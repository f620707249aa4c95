#include "frames/obj_frames.h"

#include <filesystem>
#include <memory>

#include "common/whole_file.h"
#include "frames/numbered_frames.h"
#include "meshes/obj_file.h"
#include "percale/error.h"

namespace percale::scenes {

const ObjLayout* ObjMeshes::layout_of(const std::string& obj_file, const TriangleMesh& mesh) {
    if (obj_file.empty()) return nullptr;
    const auto [entry, fresh] = layouts_.try_emplace(obj_file);
    std::optional<ObjLayout>& layout = entry->second;
    try {
        if (fresh) layout.emplace(obj_file);
    } catch (const SceneError&) {
        return nullptr;  // the simulated mesh is the one that was read before
    }
    return layout && layout->fits(mesh) ? &*layout : nullptr;
}

void ObjMeshes::write(const std::string& path, const TriangleMesh& mesh, const std::string& obj_file) {
    if (const ObjLayout* layout = layout_of(obj_file, mesh))
        write_whole_file(path, layout->text(mesh.vertices, std::filesystem::path(path).parent_path().string()));
    else
        write_obj(path, mesh.vertices, mesh.triangles);
}

FrameFormat obj_frames() {
    const auto make = [](const FrameCast& cast) {
        const auto meshes = std::make_shared<ObjMeshes>();
        return numbered_frames(cast, ".obj", [meshes](const std::string& path, const NumberedMesh& shape) {
            meshes->write(path, shape.mesh, shape.obj_file);
        });
    };
    return {.word = "obj",
            .sentence = "a Wavefront OBJ file for every mesh and frame, with what the mesh's own OBJ file has",
            .endings = {".obj"},
            .exact = true,
            .bytes =
                [](const MeshCounts& mesh) {
                    return FrameBytes{0.0, 60.0 * mesh.vertices + 20.0 * mesh.triangles};
                },
            .make = make};
}

}  // namespace percale::scenes
