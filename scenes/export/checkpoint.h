#pragma once

#include <string>

#include "export/run_folder.h"
#include "run/run_scene.h"

namespace percale::scenes {

/// An unfinished run, with all that is needed to continue it.
struct Checkpoint {
    std::string settings;  // settings_text of its scene
    bool certify_steps = false, replay_hash = false;
    RunState run;
    FolderState folder;
};

/// Writes it as a whole file that survives a loss of power. Throws SceneError naming a file that cannot be written.
void write_checkpoint(const std::string& file, const Checkpoint& checkpoint);

/// The options of a run besides its scene.
struct RunMarks {
    bool certify_steps = false, replay_hash = false;
};

/// The checkpoint of a run in its folder, which then holds what is needed to go on. Throws like write_checkpoint.
void save_run(const std::string& file, const Scene& scene, const RunState& state, const RunMarks& marks, RunFolder& folder);

/// Throws SceneError naming the file where it is no checkpoint, of another version, cut off or damaged.
Checkpoint read_checkpoint(const std::string& file);

/// Throws SceneError naming the file and the first settings that differ, with both values, where a checkpoint is not of this
/// scene, or was made with other options. The number of threads may differ.
void check_same_run(const std::string& file, const Checkpoint& checkpoint, const Scene& scene, bool certify_steps,
                    bool replay_hash);

}  // namespace percale::scenes
