#pragma once

#include <map>
#include <optional>
#include <string>

#include "frames/frame_format.h"
#include "frames/obj_layout.h"

namespace percale::scenes {

/// Wavefront OBJ.
FrameFormat obj_frames();

/// Writes meshes as the OBJ files that they come from have them (ObjLayout), where they are those of a file, else as triangles.
class ObjMeshes {
public:
    /// `obj_file`: "" for none. A file that cannot be read, or has changed, is none. Whole or not at all; throws SceneError.
    void write(const std::string& path, const TriangleMesh& mesh, const std::string& obj_file);

private:
    const ObjLayout* layout_of(const std::string& obj_file, const TriangleMesh& mesh);

    std::map<std::string, std::optional<ObjLayout>> layouts_;  // by file; nothing: of no use
};

}  // namespace percale::scenes
