#include "page/page_data.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace percale::scenes {

using nlohmann::ordered_json;

namespace {

/// The names in a list of tables, as far as there are any.
std::vector<std::string> names_in_settings(const ordered_json& report, const char* list) {
    std::vector<std::string> names;
    if (!report.is_object() || !report.contains("settings")) return names;
    const ordered_json& settings = report["settings"];
    if (!settings.is_object() || !settings.contains(list) || !settings[list].is_array()) return names;
    for (const ordered_json& item : settings[list])
        if (item.is_object() && item.contains("name") && item["name"].is_string()) names.push_back(item["name"]);
    return names;
}

std::vector<std::string> names_for(const std::vector<std::string>& files, std::vector<std::string> names) {
    if (names.size() == files.size()) return names;
    names.clear();
    for (const std::string& file : files) names.push_back(std::filesystem::path(file).stem().string());
    return names;
}

ordered_json range_json(const PackRange& range) { return {{"low", range.low}, {"step", range.step}}; }

ordered_json field_json(const PlaybackField& field, const std::string& id) {
    return {{"name", field.name}, {"of_frames", field.of_frames}, {"range", range_json(field.range)},
            {"low", field.low},   {"high", field.high},           {"values", id}};
}

std::string blob_id(std::size_t mesh, const std::string& what) { return "mesh-" + std::to_string(mesh) + "-" + what; }

ordered_json mesh_json(const PlaybackMesh& mesh, std::size_t number) {
    ordered_json json = {{"name", mesh.name},
                         {"cloth", mesh.is_cloth},
                         {"moves", mesh.moves},
                         {"vertices", mesh.vertices},
                         {"triangles", mesh.triangles},
                         {"axes", {range_json(mesh.axes[0]), range_json(mesh.axes[1]), range_json(mesh.axes[2])}},
                         {"corners", blob_id(number, "corners")},
                         {"positions", blob_id(number, "positions")},
                         {"fields", ordered_json::array()}};
    for (std::size_t i = 0; i < mesh.fields.size(); ++i)
        json["fields"].push_back(field_json(mesh.fields[i], blob_id(number, "field-" + std::to_string(i))));
    return json;
}

ordered_json frames_json(const std::vector<FrameRecord>& records) {
    ordered_json list = ordered_json::array();
    for (const FrameRecord& record : records)
        list.push_back({{"index", record.index},
                        {"time", record.time},
                        {"intersections", record.check.intersections},
                        {"deepest_penetration", record.check.deepest_penetration},
                        {"smallest_distance", record.check.smallest_distance}});
    return list;
}

ordered_json steps_json(const StepSeries& steps) {
    ordered_json json = {{"steps", steps.steps}, {"every", steps.every},         {"time", steps.time},
                         {"bad", steps.bad},     {"bad_steps", steps.bad_steps}, {"columns", ordered_json::object()}};
    for (const StepColumn& column : steps.columns) {
        json["columns"][column.name] = {{"least", column.min}};
        if (steps.every > 1) json["columns"][column.name]["most"] = column.max;
    }
    return json;
}

/// The report without what a page does not show: files of frames, and stitches one by one.
ordered_json shown_report(const std::string& text) {
    ordered_json report = ordered_json::parse(text);
    report.erase("frames");
    if (report.contains("seams") && report["seams"].is_array()) {
        for (ordered_json& seam : report["seams"]) {
            if (!seam.is_object() || !seam.contains("stitches") || !seam["stitches"].is_array()) continue;
            seam["stitches"] = seam["stitches"].size();
        }
    }
    return report;
}

std::string text_entry(const ordered_json& report, const char* key) {
    return report.is_object() && report.contains(key) && report[key].is_string() ? report[key].get<std::string>() : "";
}

}  // namespace

RunCast cast_of_report(const std::string& report, const FrameRecord& first) {
    const ordered_json json = ordered_json::parse(report);
    return {names_for(first.cloths, names_in_settings(json, "cloth")),
            names_for(first.obstacles, names_in_settings(json, "obstacle"))};
}

int worst_frame_of_report(const std::string& report, int frames) {
    const ordered_json json = ordered_json::parse(report);
    if (!json.contains("worst_frame") || !json["worst_frame"].is_number_integer()) return -1;
    const long long worst = json["worst_frame"].get<long long>();
    return worst >= 0 && worst < frames ? static_cast<int>(worst) : -1;
}

std::string title_of_report(const std::string& report) {
    const ordered_json json = ordered_json::parse(report);
    const std::string title = text_entry(json, "title");
    if (!title.empty()) return title;
    const std::string scene = std::filesystem::path(text_entry(json, "scene")).stem().string();
    return scene.empty() ? "run" : scene;
}

std::vector<PageBlob> page_blobs(const Playback& playback) {
    std::vector<PageBlob> blobs;
    for (std::size_t i = 0; i < playback.meshes.size(); ++i) {
        const PlaybackMesh& mesh = playback.meshes[i];
        blobs.push_back({blob_id(i, "corners"), mesh.corners});
        blobs.push_back({blob_id(i, "positions"), mesh.positions});
        for (std::size_t k = 0; k < mesh.fields.size(); ++k)
            blobs.push_back({blob_id(i, "field-" + std::to_string(k)), mesh.fields[k].values});
    }
    return blobs;
}

std::string page_json(const PageData& data) {
    const Playback& playback = data.playback;
    ordered_json json = {{"report", shown_report(data.report)}, {"frames", frames_json(data.records)},
                         {"steps", steps_json(data.steps)},     {"every", playback.choice.every},
                         {"shown", playback.choice.shown},      {"rounding", playback.rounding},
                         {"meshes", ordered_json::array()}};
    for (std::size_t i = 0; i < playback.meshes.size(); ++i) json["meshes"].push_back(mesh_json(playback.meshes[i], i));
    return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace percale::scenes
