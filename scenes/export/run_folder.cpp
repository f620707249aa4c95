#include "export/run_folder.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "percale/error.h"

namespace percale::scenes {

namespace fs = std::filesystem;

namespace {

void remove_file(const fs::path& path) {
    std::error_code error;
    fs::remove(path, error);
    if (error) throw SceneError(path.string() + ": cannot be replaced: " + error.message());
}

/// Replaces the file of the origin at once, so that a kill leaves no run without its own; an empty origin removes the file.
void set_origin(const std::string& folder, const std::string& origin) {
    if (origin.empty()) return remove_file(fs::path(folder) / origin_name);
    write_whole_file(folder + "/" + origin_name, origin);
}

/// Removes the page of an earlier run, which would show frames that are gone, but no other file of that name.
void remove_page(const std::string& folder) {
    std::string start(page_mark.size(), ' ');
    std::ifstream in(page_in(folder), std::ios::binary);
    if (in.read(start.data(), static_cast<std::streamsize>(start.size())) && start == page_mark) remove_file(page_in(folder));
}

std::vector<std::string> listed_files(const std::vector<FrameRecord>& frames) {
    std::vector<std::string> all;
    for (const FrameRecord& frame : frames)
        for (const auto* files : {&frame.cloths, &frame.obstacles, &frame.others})
            all.insert(all.end(), files->begin(), files->end());
    return all;
}

void remove_earlier_run(const std::string& folder, const FrameWriter& writer) {
    const fs::path report = fs::path(folder) / "report.json";
    if (!fs::exists(report)) return;
    std::vector<FrameRecord> frames;
    try {
        frames = read_frame_records(folder);
    } catch (const SceneError& error) {
        throw SceneError(std::string(error.what()) + "; name another folder with -o");
    }
    remove_page(folder);
    remove_file(report);
    remove_file(fs::path(folder) / "steps.csv");
    for (const std::string& file : listed_files(frames))
        if (writer.writes(file)) remove_file(fs::path(folder) / file);
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

/// Removes steps and frames of a run that was killed, whose table never got its name, and what a checkpoint needed.
void remove_killed_run(const std::string& folder, const FrameWriter& writer) {
    const bool killed = is_leftover(fs::path(folder) / (std::string("steps.csv") + part_suffix));
    if (killed || is_leftover(fs::path(folder) / checkpoint_name)) writer.remove_from(0);
    for (const char* name : {"steps.csv", "report.json", checkpoint_name}) remove_leftover(folder, name);
}

/// The files of frames that belong to a state, but for those that grow. Throws SceneError unless all are there.
std::vector<std::string> files_of(const FolderState& state, const std::string& folder, const FrameWriter& writer) {
    std::vector<std::string> files = listed_files(state.frames);
    for (const GrownFile& file : state.grown) files.push_back(file.name);
    for (const std::string& file : files)
        if (!writer.writes(file)) throw SceneError(file + ": is no frame of a run");
    for (const GrownFile& file : state.grown) std::erase(files, file.name);
    std::erase_if(files, [&](const std::string& file) { return writer.is_made_at_end(file); });
    for (const std::string& file : files)
        if (!fs::exists(fs::path(folder) / file))
            throw SceneError(folder + "/" + file + ": is missing, and the run cannot be resumed without it");
    return files;
}

}  // namespace

std::string page_in(const std::string& folder) { return folder + "/report.html"; }

RunFolder::RunFolder(const std::string& folder, const Scene& scene, bool with_state_hash, std::span<const FrameFormat> formats)
    : folder_(folder), with_state_hash_(with_state_hash), writer_(folder, scene, formats) {}

RunFolder::~RunFolder() {
    if (finished_) return;
    writer_.files().discard();
    if (resumable_ && steps_) steps_->leave();
    if (steps_written_ && !resumable_) std::remove((folder_ + "/steps.csv").c_str());
}

void RunFolder::begin(const std::string& origin) {
    made_.emplace(folder_);
    lock_.emplace(folder_);
    remove_earlier_run(folder_, writer_);
    remove_killed_run(folder_, writer_);
    remove_file(fs::path(folder_) / checkpoint_name);
    set_origin(folder_, origin);
    steps_.emplace(folder_ + "/steps.csv");
}

void RunFolder::begin_from(const FolderState& state, const std::string& other, const std::string& origin) {
    const std::vector<std::string> files = files_of(state, other, writer_);
    made_.emplace(folder_);
    lock_.emplace(folder_);
    std::error_code error;
    const bool here = fs::equivalent(folder_, other, error);
    steps_.emplace(folder_ + "/steps.csv", whole_or_part(other + "/steps.csv"), state.step_bytes);
    resumable_ = here;
    for (const std::string& file : files) {
        if (!here) writer_.files().copy(other, file);
    }
    for (const GrownFile& file : state.grown) writer_.files().go_on(other, file, here);
    remove_page(folder_);
    set_origin(folder_, origin);
    for (const char* name : {"report.json", "steps.csv"}) remove_file(fs::path(folder_) / name);
    for (const char* name : {"report.json", checkpoint_name}) remove_leftover(folder_, name);
    writer_.remove_from(static_cast<int>(state.frames.size()));
    frames_ = state.frames;
}

FolderState RunFolder::state() { return {frames_, steps_->sync(), writer_.files().sync()}; }

void RunFolder::keep() {
    writer_.files().keep();
    resumable_ = true;
}

void RunFolder::add(const Frame& frame) { frames_.push_back(writer_.write(frame)); }

void RunFolder::add(const StepReport& report, const Simulation& simulation) {
    steps_->add(report, with_state_hash_ ? std::optional(simulation.state_hash()) : std::nullopt);
}

void RunFolder::finish(const BuiltScene& built, const RunResult& result, std::span<const ExpectationResult> expectations) {
    steps_->finish();
    steps_written_ = true;
    std::vector<double> times;
    for (const FrameRecord& frame : frames_) times.push_back(frame.time);
    writer_.finish(times);
    write_whole_file(folder_ + "/report.json", run_report_text(built, result, frames_, expectations));
    finished_ = true;
}

}  // namespace percale::scenes
