#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/folder_lock.h"
#include "common/whole_file.h"
#include "export/frames.h"
#include "export/run_report.h"
#include "export/step_table.h"

namespace percale::scenes {

/// What a checkpoint has to know of a run's folder.
struct FolderState {
    std::vector<FrameRecord> frames;
    std::uint64_t step_bytes = 0;  // of steps.csv
    std::vector<GrownFile> grown;  // files that show several frames
};

/// The name of the checkpoint in a run's folder.
constexpr const char* checkpoint_name = "checkpoint.percale";

/// The file with the origin of a run that is kept (kept_run.h); every other run into the folder, a resumed one too, removes it.
constexpr const char* origin_name = "origin.json";

/// The path of a run's page if no other is given, and the text that pages begin with.
std::string page_in(const std::string& folder);
constexpr std::string_view page_mark = "<!DOCTYPE html><!-- the page of a run, by percale -->";

/// What a run leaves in its folder: frames, steps.csv, report.json. Without `finish` (a file could not be written) none of these
/// files stays, but for what a checkpoint needs (`keep`), nor a new folder with nothing in it.
class RunFolder {
public:
    /// Creates nothing yet. Throws SceneError where a name of the scene cannot be part of a file name.
    RunFolder(const std::string& folder, const Scene& scene, bool with_state_hash,
              std::span<const FrameFormat> formats = frame_formats());

    ~RunFolder();
    RunFolder(const RunFolder&) = delete;
    RunFolder& operator=(const RunFolder&) = delete;

    /// Makes the folder, keeps it from other runs as long as this lives (FolderLock), and removes from it what an earlier run's
    /// report lists (report.json first: until `finish` there is none), and its page. `origin`: of a run that is kept
    /// (origin_name), else "". Throws SceneError if that is not possible.
    void begin(const std::string& origin = "");
    /// Continues from the folder that another run left, which may be this one; frames and steps are copied from any other. Throws
    /// SceneError if something that belongs to the state is missing.
    void begin_from(const FolderState& state, const std::string& other, const std::string& origin = "");
    /// Flushes all steps and frames to the disk.
    FolderState state();
    /// Keeps the files for a checkpoint that holds the last value of `state`.
    void keep();
    void add(const Frame& frame);
    void add(const StepReport& report, const Simulation& simulation);
    void finish(const BuiltScene& built, const RunResult& result, std::span<const ExpectationResult> expectations);

private:
    std::string folder_;
    bool with_state_hash_;
    std::optional<OutputFolder> made_;
    std::optional<FolderLock> lock_;
    FrameWriter writer_;
    std::optional<StepTable> steps_;
    std::vector<FrameRecord> frames_;
    bool steps_written_ = false, resumable_ = false, finished_ = false;
};

}  // namespace percale::scenes
