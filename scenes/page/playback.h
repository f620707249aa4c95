#pragma once

#include <span>
#include <string>
#include <vector>

#include "export/frames.h"
#include "page/frame_choice.h"
#include "page/mesh_track.h"

namespace percale::scenes {

/// Whose shapes a run shows, in the order of its frames.
struct RunCast {
    std::vector<std::string> cloths, obstacles;  // names
};

struct PlaybackOptions {
    std::size_t max_bytes = 50'000'000;  // of all meshes and frames as text
    bool distances = true;               // of cloth to obstacles, where the frames do not have them
    int worst_frame = -1;                // shown whatever is left out; -1: none
};

/// The frames of a run as a page plays them.
struct Playback {
    FrameChoice choice;  // nothing is shown of a run that wrote no frames
    std::vector<PlaybackMesh> meshes;
    double rounding = 0.0;  // m, by which a shown coordinate may be off, but for the rounding of floats
};

/// Reads the frames that a run lists. Fields of vertices are those of the files; without any of strain, `edge_change` takes its
/// place, and without a distance `distance` is measured. Throws SceneError naming the file that is missing, broken, of a format
/// that a page cannot show, or of another mesh than frame 0 has, and where not even the first and the last frame fit.
Playback read_playback(const std::string& folder, std::span<const FrameRecord> records, const RunCast& cast,
                       const PlaybackOptions& options);

}  // namespace percale::scenes
