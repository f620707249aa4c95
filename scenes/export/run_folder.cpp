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

}  // namespace

RunFolder::RunFolder(const std::string& folder, const Scene& scene, bool with_state_hash)
    : folder_(folder),
      with_frames_(scene.output.frames != FrameFormat::none),
      with_state_hash_(with_state_hash),
      writer_(folder, scene) {}

RunFolder::~RunFolder() {
    if (finished_) return;
    writer_.discard();
    if (steps_written_) std::remove((folder_ + "/steps.csv").c_str());
}

void RunFolder::begin() {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error || !fs::is_directory(folder_))
        throw SceneError(folder_ + ": cannot be made: " + (error ? error.message() : "it is a file"));
    remove_earlier_run(folder_);
    steps_.emplace(folder_ + "/steps.csv");
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
