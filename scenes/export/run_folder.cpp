#include "export/run_folder.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "percale/error.h"

namespace percale::scenes {

namespace fs = std::filesystem;

namespace {

/// Whether a listed file is one that a run writes: never anything above or beside its folder.
bool is_frame_file(const fs::path& path) {
    const std::string parent = path.parent_path().string();
    return (parent == "frames" || parent == "obstacles") && path.extension() == ".obj";
}

void remove_file(const fs::path& path) {
    std::error_code error;
    fs::remove(path, error);
    if (error) throw SceneError(path.string() + ": cannot be replaced: " + error.message());
}

void remove_frame_files(const std::string& folder, const std::vector<std::string>& files) {
    for (const std::string& file : files)
        if (is_frame_file(file)) remove_file(fs::path(folder) / file);
}

void remove_earlier_run(const std::string& folder) {
    const fs::path report = fs::path(folder) / "report.json";
    if (!fs::exists(report)) return;
    std::vector<FrameRecord> frames;
    try {
        frames = read_frame_records(folder);
    } catch (const SceneError& error) {
        throw SceneError(std::string(error.what()) + "; name another folder with -o");
    }
    remove_file(report);
    remove_file(fs::path(folder) / "steps.csv");
    for (const FrameRecord& frame : frames) {
        remove_frame_files(folder, frame.cloths);
        remove_frame_files(folder, frame.obstacles);
    }
}

/// A file that a run was writing when it was killed.
bool is_leftover(const fs::path& file) {
    std::error_code error;
    return fs::symlink_status(file, error).type() == fs::file_type::regular;
}

void remove_leftover(const std::string& folder, const char* name) {
    const fs::path file = fs::path(folder) / (std::string(name) + part_suffix);
    if (is_leftover(file)) remove_file(file);
}

/// Steps and frames of a run that was killed: its table never got its name.
void remove_killed_run(const std::string& folder, const FrameWriter& writer) {
    if (is_leftover(fs::path(folder) / (std::string("steps.csv") + part_suffix))) writer.remove_from(0);
    for (const char* name : {"steps.csv", "report.json", checkpoint_name}) remove_leftover(folder, name);
}

/// The steps of a run that was stopped, or of one that was killed.
std::string step_file(const std::string& folder) {
    const std::string whole = folder + "/steps.csv", part = whole + part_suffix;
    return is_leftover(part) ? part : whole;
}

/// All files of frames in a folder. Throws SceneError unless all are there.
std::vector<std::string> files_of(const std::vector<FrameRecord>& frames, const std::string& folder) {
    std::vector<std::string> all;
    for (const FrameRecord& frame : frames) {
        for (const auto* files : {&frame.cloths, &frame.obstacles}) all.insert(all.end(), files->begin(), files->end());
    }
    for (const std::string& file : all) {
        if (!is_frame_file(file)) throw SceneError(file + ": is no frame of a run");
        if (!fs::exists(fs::path(folder) / file))
            throw SceneError(folder + "/" + file + ": is missing, and the run cannot be resumed without it");
    }
    return all;
}

}  // namespace

RunFolder::RunFolder(const std::string& folder, const Scene& scene, bool with_state_hash)
    : folder_(folder),
      with_frames_(scene.output.frames != FrameFormat::none),
      with_state_hash_(with_state_hash),
      writer_(folder, scene) {}

RunFolder::~RunFolder() {
    if (finished_) return;
    writer_.discard();
    if (resumable_ && steps_) steps_->leave();
    if (steps_written_ && !resumable_) std::remove((folder_ + "/steps.csv").c_str());
}

void RunFolder::begin() {
    made_.emplace(folder_);
    remove_earlier_run(folder_);
    remove_killed_run(folder_, writer_);
    remove_file(fs::path(folder_) / checkpoint_name);
    steps_.emplace(folder_ + "/steps.csv");
}

void RunFolder::begin_from(const FolderState& state, const std::string& other) {
    const std::vector<std::string> files = files_of(state.frames, other);
    made_.emplace(folder_);
    std::error_code error;
    const bool here = fs::equivalent(folder_, other, error);
    steps_.emplace(folder_ + "/steps.csv", step_file(other), state.step_bytes);
    resumable_ = here;
    for (const std::string& file : files) {
        if (!here) writer_.copy(other, file);
    }
    for (const char* name : {"report.json", "steps.csv"}) remove_file(fs::path(folder_) / name);
    for (const char* name : {"report.json", checkpoint_name}) remove_leftover(folder_, name);
    writer_.remove_from(static_cast<int>(state.frames.size()));
    frames_ = state.frames;
}

FolderState RunFolder::state() { return {frames_, steps_->sync()}; }

void RunFolder::keep() {
    writer_.keep();
    resumable_ = true;
}

void RunFolder::add(const Frame& frame) {
    frames_.push_back(with_frames_ ? writer_.write(frame) : FrameRecord{frame.index, frame.time, {}, {}, frame.check, {}});
}

void RunFolder::add(const StepReport& report, const Simulation& simulation) {
    steps_->add(report, with_state_hash_ ? std::optional(simulation.state_hash()) : std::nullopt);
}

void RunFolder::finish(const BuiltScene& built, const RunResult& result, std::span<const ExpectationResult> expectations) {
    steps_->finish();
    steps_written_ = true;
    write_whole_file(folder_ + "/report.json", run_report_text(built, result, frames_, expectations));
    finished_ = true;
}

}  // namespace percale::scenes
