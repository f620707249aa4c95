#include "export/frames.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <system_error>

#include "common/text.h"
#include "common/whole_file.h"
#include "garment/cloth_shape.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"
#include "run/obstacle_motion.h"

namespace percale::scenes {

namespace fs = std::filesystem;

namespace {

std::string words_with_fields(std::span<const FrameFormat> formats) {
    std::vector<std::string> words = {no_frames};
    for (const FrameFormat& format : formats) {
        if (format.holds_fields) words.push_back(format.word);
    }
    return joined(words);
}

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

/// An OBJ file whose vertices a cloth or an obstacle has, as they lie there; "" where there is none.
template <class Spec>
std::string obj_file_of(const Scene& scene, const Spec& spec) {
    bool is_list = false;
    if constexpr (requires { spec.frames; }) is_list = spec.frames.has_value();
    const bool has = !is_list && spec.part.empty() && extension_of(spec.mesh) == ".obj";
    return has ? path_beside(scene, spec.mesh) : "";
}

FrameCast cast_of(const Scene& scene) {
    FrameCast cast{.cloths = file_names("cloth", scene.cloths),
                   .obstacles = file_names("obstacle", scene.obstacles),
                   .obstacle_moves = {},
                   .fps = scene.output.fps};
    for (const ClothSpec& cloth : scene.cloths) cast.cloth_files.push_back(obj_file_of(scene, cloth));
    for (const ObstacleSpec& obstacle : scene.obstacles) {
        cast.obstacle_files.push_back(obj_file_of(scene, obstacle));
        cast.obstacle_moves.push_back(obstacle_changes(obstacle));
    }
    return cast;
}

/// Throws SceneError for a word that no format has. Exact formats come first; where fields are written, formats that hold fields
/// come first among the others and among the exact ones.
std::vector<const FrameFormat*> formats_of(const OutputSpec& output, std::span<const FrameFormat> formats) {
    std::vector<const FrameFormat*> chosen;
    for (const std::string& word : output.frames) {
        const auto found = std::ranges::find(formats, word, &FrameFormat::word);
        if (found != formats.end()) chosen.push_back(&*found);
        if (found != formats.end() || word == no_frames) continue;
        std::vector<std::string> valid = {no_frames};
        for (const FrameFormat& format : formats) valid.push_back(format.word);
        throw SceneError("output.frames: no such frame format: '" + word + "'; valid: " + joined(valid));
    }
    if (!output.fields.empty()) std::stable_partition(chosen.begin(), chosen.end(), std::mem_fn(&FrameFormat::holds_fields));
    std::stable_partition(chosen.begin(), chosen.end(), std::mem_fn(&FrameFormat::exact));
    return chosen;
}

void append_new(std::vector<std::string>& names, const std::vector<std::string>& more) {
    for (const std::string& name : more) {
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
}

}  // namespace

FrameWriter::FrameWriter(const std::string& folder, const Scene& scene, std::span<const FrameFormat> formats)
    : folder_(folder), formats_(formats), cast_(cast_of(scene)), files_(folder) {
    bool holds_fields = false;
    for (const FrameFormat* format : formats_of(scene.output, formats)) {
        encoders_.push_back(format->make(cast_));
        holds_fields = holds_fields || format->holds_fields;
    }
    if (scene.output.fields.empty() || encoders_.empty() || holds_fields) return;
    throw SceneError("output.fields: output.frames = \"" + joined(scene.output.frames) +
                     "\" holds no fields; with them it must be one of " + words_with_fields(formats_));
}

FrameRecord FrameWriter::write(const Frame& frame) {
    FrameRecord record{frame.index, frame.time, {}, {}, {}, frame.check, {}};
    for (const auto& encoder : encoders_) {
        FrameFiles files = encoder->write({frame.index, frame.time, frame.cloths, frame.obstacles, frame.fields}, files_);
        append_new(record.others, files.others);
        if (encoder == encoders_.front()) {
            record.cloths = std::move(files.cloths);
            record.obstacles = std::move(files.obstacles);
            continue;
        }
        for (const auto& more : {files.cloths, files.obstacles}) append_new(record.others, more);
    }
    files_.check();
    if (!record.cloths.empty()) record.meeting = frame.meeting;
    return record;
}

void FrameWriter::finish(std::span<const double> times) {
    for (const auto& encoder : encoders_) encoder->finish(times, files_);
    files_.finish();
}

bool FrameWriter::is_made_at_end(const std::string& name) const {
    return std::ranges::any_of(encoders_, [&](const auto& encoder) { return encoder->is_made_at_end(name); });
}

bool FrameWriter::writes(const std::string& name) const {
    const std::string parent = fs::path(name).parent_path().string(), ending = fs::path(name).extension().string();
    const auto has_ending = [&](const FrameFormat& format) {
        return std::find(format.endings.begin(), format.endings.end(), ending) != format.endings.end();
    };
    return (parent == "frames" || parent == "obstacles") && std::any_of(formats_.begin(), formats_.end(), has_ending);
}

void FrameWriter::remove_from(int frame) const {
    for (const char* folder : {"frames", "obstacles"}) remove_from(frame, folder);
}

void FrameWriter::remove_from(int frame, const std::string& folder) const {
    std::vector<std::unique_ptr<FrameEncoder>> encoders;
    for (const FrameFormat& format : formats_) encoders.push_back(format.make(cast_));
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder_ + "/" + folder, error)) {
        const std::string name = folder + "/" + without_part_suffix(entry.path().filename().string());
        const bool ours = std::any_of(encoders.begin(), encoders.end(),
                                      [&](const auto& encoder) { return encoder->first_frame_of(name) >= frame; });
        if (ours && entry.symlink_status().type() == fs::file_type::regular) fs::remove(entry.path(), error);
    }
}

}  // namespace percale::scenes
