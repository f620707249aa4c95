#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "format/scene.h"
#include "frames/frame_folder.h"
#include "frames/frame_formats.h"
#include "run/run_scene.h"

namespace percale::scenes {

/// One output frame as a report lists it: where its meshes are, relative to the output folder, and what the certificate said.
struct FrameRecord {
    int index = 0;
    double time = 0.0;                   // s
    std::vector<std::string> cloths;     // in the order of the scene; empty if nothing was written
    std::vector<std::string> obstacles;  // in the order of the scene; a resting one has the same file in every frame
    std::vector<std::string> others;     // files of other formats, and what goes with them
    FrameCheck check;
    PairsOfCloths meeting;  // of `cloths`, by number, that meet each other (self_contact)
};

/// Writes the frames of a scene in the formats that it names (output.frames) into FOLDER/frames and FOLDER/obstacles, whole or
/// not at all. Cloths and obstacles of a record are the files of the first exact format (where fields are written, of one that
/// holds them), or of the first format if none is exact.
class FrameWriter {
public:
    /// Creates nothing yet. Throws SceneError for a name that cannot be part of a file name or that two cloths or two obstacles
    /// share, and for a word that no format has.
    FrameWriter(const std::string& folder, const Scene& scene, std::span<const FrameFormat> formats = frame_formats());

    /// Throws SceneError naming the file that cannot be written.
    FrameRecord write(const Frame& frame);
    /// Completes files that grow over the run. `times`: of all frames, s.
    void finish(std::span<const double> times);
    /// The files that are written, for a checkpoint and for what cannot be finished.
    FrameFolder& files() { return files_; }

    /// Whether a listed file is not there before `finish`.
    bool is_made_at_end(const std::string& name) const;
    /// Whether a listed file is one that a run writes, in whatever format: never anything above or beside its folder.
    bool writes(const std::string& name) const;
    /// Removes what runs of this scene have left, whole or not and in whatever format, of frames from this number on.
    void remove_from(int frame) const;

private:
    void remove_from(int frame, const std::string& folder) const;

    std::string folder_;
    std::span<const FrameFormat> formats_;
    FrameCast cast_;
    FrameFolder files_;
    std::vector<std::unique_ptr<FrameEncoder>> encoders_;  // the one whose files are those of a record first; empty: no frames
};

}  // namespace percale::scenes
