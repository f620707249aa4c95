#include "export/kept_run.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "bodies/mesh_sequence.h"
#include "common/input_file.h"
#include "common/own_program.h"
#include "common/text.h"
#include "export/run_folder.h"
#include "export/run_settings.h"
#include "format/expectations.h"
#include "garment/cloth_shape.h"
#include "measures/measures.h"
#include "percale/error.h"
#include "percale/saved_state.h"
#include "report/csv.h"

namespace percale::scenes {
namespace {

/// Checkpoints of a run that is kept, over the longest that its scene may take. Fewer: more is run again after a kill. More: a
/// short scene spends its time writing.
constexpr double checkpoints_of_kept_run = 20.0;

}  // namespace

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

std::string checksum_text(const std::string& file) { return hexadecimal(checksum(read_bytes(file))); }

/// The kind of a file; file_type::not_found where there is none.
fs::file_type kind_of(const std::string& path) {
    std::error_code error;
    const fs::file_type kind = fs::status(path, error).type();
    if (kind == fs::file_type::none) throw SceneError(path + ": cannot be read: " + error.message());
    return kind;
}

bool is_there(const std::string& path) { return kind_of(path) != fs::file_type::not_found; }

std::size_t expected_count(const Scene& scene, const RunMarks& marks) {
    return marks.certify_steps ? with_every_step(scene.expectations).size() : scene.expectations.size();
}

/// The expectations, each number with all its digits, infinity included.
ordered_json expectation_list(const Scene& scene) {
    ordered_json list = ordered_json::array();
    for (const Expectation& one : scene.expectations)
        list.push_back({{"measure", one.measure},
                        {"file", one.file},
                        {"when", when_text(one)},
                        {"lowest", number_text(one.lowest)},
                        {"lowest_included", one.lowest_included},
                        {"highest", number_text(one.highest)},
                        {"highest_included", one.highest_included}});
    return list;
}

void add_files(const ObstacleSpec& obstacle, std::set<std::string>& names) {
    names.insert({obstacle.cache, obstacle.start_mesh});
    if (!obstacle.frames) {
        names.insert(obstacle.mesh);
        return;
    }
    const FramePattern pattern = frame_pattern(obstacle.mesh);
    for (int frame = (*obstacle.frames)[0]; frame <= (*obstacle.frames)[1]; ++frame) names.insert(pattern.name_of(frame));
}

/// The files that a scene names, as the scene writes them.
std::set<std::string> named_files(const Scene& scene) {
    std::set<std::string> names;
    for (const ClothSpec& cloth : scene.cloths) {
        names.insert({cloth.mesh, cloth.pattern});
        if (cloth.rest != "uv") names.insert(cloth.rest);
    }
    for (const ObstacleSpec& obstacle : scene.obstacles) add_files(obstacle, names);
    for (const SeamSpec& seam : scene.seams) {
        if (seam.file != "mesh") names.insert(seam.file);
    }
    for (const Expectation& expectation : scene.expectations) names.insert(expectation.file);
    names.erase("");
    return names;
}

/// The first difference between two origins besides their settings, in words.
std::string changed_beside_settings(const ordered_json& now, const ordered_json& before) {
    if (now.at("program") != before.at("program")) return "it was made by another program";
    for (const char* option : {"--certify-steps", "--replay-hash"}) {
        const bool asked = now.at(option);
        if (asked != before.at(option).get<bool>()) return std::string("it was made ") + (asked ? "without " : "with ") + option;
    }
    if (now.at("expectations") != before.at("expectations")) return "expectations have changed";
    for (const auto& [file, sum] : now.at("files").items()) {
        if (!before.at("files").contains(file) || before.at("files").at(file) != sum) return file + " has changed";
    }
    return now.at("files") == before.at("files") ? "" : "it read other files";
}

}  // namespace

std::optional<EndedRun> ended_run(const std::string& folder) {
    std::ifstream in = open_input(folder + "/report.json");
    if (!in) return std::nullopt;
    try {
        const auto json = nlohmann::json::parse(in);
        EndedRun run;
        run.status = json.at("status");
        run.reason = json.value("reason", "");
        run.steps = json.value("steps", 0);
        run.simulated_s = json.value("simulated_s", 0.0);
        run.wall_s = json.value("wall_s", 0.0);
        for (const auto& [name, value] : json.items())
            if (value.is_number()) run.numbers[name] = value.get<double>();
        // Reports of earlier builds have no texts.
        for (const auto& one : json.value("expectations", nlohmann::json::array()))
            run.expectations.push_back({one.at("passed"), one.value("text", "")});
        if (run.status == status_word(RunStatus::stopped)) return std::nullopt;
        return run;
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

std::string program_checksum() {
    std::string sums;
    for (const std::string& file : own_files()) sums += checksum_text(file) + " " + fs::path(file).filename().string() + "\n";
    return std::string(PERCALE_VERSION) + " " + hexadecimal(checksum(std::as_bytes(std::span(sums))));
}

std::string run_origin(const Scene& scene, const RunMarks& marks, const std::string& program) {
    ordered_json files = {{fs::path(scene.file).filename().string(), checksum_text(scene.file)}};
    for (const std::string& name : named_files(scene)) {
        const std::string path = path_beside(scene, name);
        files[name] = kind_of(path) == fs::file_type::regular ? checksum_text(path) : "missing";
    }
    const ordered_json json = {{"program", program},
                               {"--certify-steps", marks.certify_steps},
                               {"--replay-hash", marks.replay_hash},
                               {"expectations", expectation_list(scene)},
                               {"files", files},
                               {"settings", ordered_json::parse(settings_text(scene))}};
    return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string changed_origin(const std::string& now, const std::string& before) {
    try {
        const ordered_json here = ordered_json::parse(now), there = ordered_json::parse(before);
        const std::string settings = different_settings(here.at("settings").dump(), there.at("settings").dump(), "was");
        return settings.empty() ? changed_beside_settings(here, there) : settings;
    } catch (const ordered_json::exception&) {
        return std::string(origin_name) + " is damaged";
    }
}

KeptRun::KeptRun(std::string folder, const Scene& scene, const RunMarks& marks, const std::string& program)
    : folder_(std::move(folder)), origin_(run_origin(scene, marks, program)), marks_(marks) {
    look(scene);
}

void KeptRun::look(const Scene& scene) {
    const std::string origin = folder_ + "/" + origin_name, checkpoint = folder_ + "/" + checkpoint_name;
    if (!is_there(origin)) {
        for (const std::string& other : {folder_ + "/report.json", checkpoint})
            if (is_there(other)) throw SceneError(other + ": is of a run that is not kept here; name another folder");
        return;
    }
    why_again_ = changed_origin(origin_, read_text(origin));
    if (!why_again_.empty()) return;
    ended_ = ended_run(folder_);
    if (ended_ && ended_->expectations.size() != expected_count(scene, marks_)) {
        ended_.reset();
        why_again_ = "report.json has other expectations";
        return;
    }
    if (ended_ || !is_there(checkpoint)) return;
    try {
        from_ = read_checkpoint(checkpoint);
        check_same_run(checkpoint, *from_, scene, marks_.certify_steps, marks_.replay_hash);
    } catch (const SceneError& error) {
        from_.reset();
        why_again_ = error.what();
    }
}

std::string KeptRun::state_hash() const {
    std::ifstream in = open_input(folder_ + "/steps.csv");
    std::string header, line, last;
    std::getline(in, header);
    while (std::getline(in, line)) last = line;
    const std::optional<std::size_t> column = csv_column(csv_cells(header), "state_hash");
    const std::vector<std::string> cells = csv_cells(last);
    return column && *column < cells.size() ? cells[*column] : "";
}

RunResult KeptRun::run(BuiltScene& built, const RunHooks& stops, std::span<const Expectation> expectations) {
    const std::string checkpoint = folder_ + "/" + checkpoint_name;
    RunFolder folder(folder_, built.scene, marks_.replay_hash);
    RunHooks hooks;
    hooks.begin = [&] {
        if (from_) return folder.begin_from(from_->folder, folder_, origin_);
        folder.begin(origin_);
    };
    hooks.frame = [&](const Frame& frame) { folder.add(frame); };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) { folder.add(report, simulation); };
    hooks.stop_asked = stops.stop_asked;
    hooks.cancel = stops.cancel;
    hooks.checkpoint = [&](const RunState& state) { save_run(checkpoint, built.scene, state, marks_, folder); };
    RunSettings settings{.certify_steps = marks_.certify_steps};
    settings.checkpoint_every = built.scene.latest_end() / checkpoints_of_kept_run;
    settings.from = from_ ? &from_->run : nullptr;
    settings.from_file = from_ ? checkpoint : "";
    RunResult result = run_scene(built, hooks, settings);
    folder.finish(built, result, judge_run(expectations, result.measures, result.timed, built.scene));
    // A checkpoint that stays does no harm: the report is looked at first, and the next run into the folder removes it.
    std::error_code error;
    if (result.status != RunStatus::stopped) fs::remove(checkpoint, error);
    return result;
}

}  // namespace percale::scenes
