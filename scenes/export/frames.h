#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/whole_file.h"
#include "run/run_scene.h"

namespace percale::scenes {

/// One output frame as a report lists it: where its meshes are, relative to the output folder, and what the certificate said.
struct FrameRecord {
    int index = 0;
    double time = 0.0;                   // s
    std::vector<std::string> cloths;     // in the order of the scene; empty if nothing was written
    std::vector<std::string> obstacles;  // in the order of the scene; a resting one has the same file in every frame
    FrameCheck check;
    std::vector<std::string> meeting;  // those of `cloths` that meet each other (self_contact)
};

/// Writes FOLDER/frames/<cloth>_00000.obj and FOLDER/obstacles/<obstacle>_00000.obj, whole or not at all.
class FrameWriter {
public:
    /// Creates nothing yet. Throws SceneError for a name that cannot be part of a file name or that two cloths or two obstacles
    /// share.
    FrameWriter(const std::string& folder, const Scene& scene);

    /// Throws SceneError naming the file that cannot be written.
    FrameRecord write(const Frame& frame);
    /// Copies a file from another run's folder.
    void copy(const std::string& folder, const std::string& name);
    /// Removes every file written since the construction or the last call of `keep`.
    void discard();
    void keep() { written_.clear(); }
    /// Removes what runs of this scene have left, whole or not, of frames from this number on.
    void remove_from(int frame) const;

private:
    void need_folder(const std::string& name);
    void write_mesh(const std::string& name, const TriangleMesh& mesh);

    std::string folder_;
    std::vector<std::string> cloth_names_, obstacle_names_;
    std::vector<bool> obstacle_moves_, cloth_meets_;
    std::vector<std::string> written_;
    std::map<std::string, OutputFolder> folders_;
};

}  // namespace percale::scenes
