#include "export/frames.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "common/whole_file.h"
#include "meshes/obj_file.h"
#include "percale/error.h"
#include "run/obstacle_motion.h"

namespace percale::scenes {

namespace {

void check_name(const std::string& what, const std::string& name) {
    if (!name.empty() && name.front() != '.' && name.find_first_of(std::string("/\\\0\n\r", 5)) == std::string::npos) return;
    throw SceneError(what + " '" + name +
                     "': the name becomes part of a file name, so it must not be empty, start with a point " + "or hold / or \\");
}

template <class Spec>
std::vector<std::string> file_names(const std::string& what, const std::vector<Spec>& specs) {
    std::vector<std::string> names;
    for (const Spec& spec : specs) {
        check_name(what, spec.name);
        if (std::find(names.begin(), names.end(), spec.name) != names.end())
            throw SceneError(what + " '" + spec.name + "': the name is used twice, but frames are named after it");
        names.push_back(spec.name);
    }
    return names;
}

std::string numbered(const std::string& folder, const std::string& name, int index) {
    char number[16];
    std::snprintf(number, sizeof number, "_%05d.obj", index);
    return folder + "/" + name + number;
}

}  // namespace

FrameWriter::FrameWriter(const std::string& folder, const Scene& scene)
    : folder_(folder), cloth_names_(file_names("cloth", scene.cloths)), obstacle_names_(file_names("obstacle", scene.obstacles)) {
    for (const ObstacleSpec& obstacle : scene.obstacles) obstacle_moves_.push_back(obstacle_moves(obstacle));
    for (const ClothSpec& cloth : scene.cloths) cloth_meets_.push_back(scene.meets_cloth(cloth));
}

FrameRecord FrameWriter::write(const Frame& frame) {
    FrameRecord record{frame.index, frame.time, {}, {}, frame.check, {}};
    need_folder("frames");
    if (!frame.obstacles.empty()) need_folder("obstacles");
    for (std::size_t i = 0; i < frame.cloths.size(); ++i) {
        record.cloths.push_back(numbered("frames", cloth_names_[i], frame.index));
        if (cloth_meets_[i]) record.meeting.push_back(record.cloths.back());
        write_mesh(record.cloths.back(), frame.cloths[i]);
    }
    for (std::size_t i = 0; i < frame.obstacles.size(); ++i) {
        record.obstacles.push_back(numbered("obstacles", obstacle_names_[i], obstacle_moves_[i] ? frame.index : 0));
        if (obstacle_moves_[i] || frame.index == 0) write_mesh(record.obstacles.back(), frame.obstacles[i]);
    }
    return record;
}

void FrameWriter::need_folder(const std::string& name) { folders_.try_emplace(name, folder_ + "/" + name); }

void FrameWriter::write_mesh(const std::string& name, const TriangleMesh& mesh) {
    const std::string file = folder_ + "/" + name;
    write_obj(file, mesh.vertices, mesh.triangles);
    written_.push_back(file);
}

namespace {

/// The number in NAME_NUMBER.obj, with or without the suffix of an unfinished file; -1 for other names.
int frame_number(std::string file, const std::string& name) {
    if (file.ends_with(part_suffix)) file.resize(file.size() - std::string(part_suffix).size());
    if (!file.starts_with(name + "_") || !file.ends_with(".obj")) return -1;
    const std::string number = file.substr(name.size() + 1, file.size() - name.size() - 5);
    const bool digits = number.size() >= 5 && number.size() <= 9 && number.find_first_not_of("0123456789") == std::string::npos;
    return digits ? std::stoi(number) : -1;
}

void remove_numbered(const std::string& folder, const std::vector<std::string>& names, int first) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string file = entry.path().filename().string();
        const bool ours =
            std::any_of(names.begin(), names.end(), [&](const std::string& name) { return frame_number(file, name) >= first; });
        if (ours && entry.symlink_status().type() == std::filesystem::file_type::regular)
            std::filesystem::remove(entry.path(), error);
    }
}

}  // namespace

void FrameWriter::copy(const std::string& folder, const std::string& name) {
    namespace fs = std::filesystem;
    const std::string from = folder + "/" + name, to = folder_ + "/" + name, part = to + part_suffix;
    need_folder(fs::path(name).parent_path().string());
    std::error_code error;
    fs::copy_file(from, part, fs::copy_options::overwrite_existing, error);
    if (!error) fs::rename(part, to, error);
    if (error) throw SceneError(from + ": cannot be copied to " + to + ": " + error.message());
    written_.push_back(to);
}

void FrameWriter::remove_from(int frame) const {
    remove_numbered(folder_ + "/frames", cloth_names_, frame);
    remove_numbered(folder_ + "/obstacles", obstacle_names_, frame);
}

void FrameWriter::discard() {
    for (const std::string& file : written_) std::remove(file.c_str());
    written_.clear();
}

}  // namespace percale::scenes
