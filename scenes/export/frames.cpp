#include "export/frames.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "common/text.h"
#include "common/whole_file.h"
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

FrameCast cast_of(const Scene& scene) {
    FrameCast cast{.cloths = file_names("cloth", scene.cloths),
                   .obstacles = file_names("obstacle", scene.obstacles),
                   .obstacle_moves = {},
                   .fps = scene.output.fps};
    for (const ObstacleSpec& obstacle : scene.obstacles)
        cast.obstacle_moves.push_back(obstacle_moves(obstacle) || obstacle.yields);
    return cast;
}

std::unique_ptr<FrameEncoder> encoder_of(const std::string& word, const FrameCast& cast, std::span<const FrameFormat> formats) {
    if (word == no_frames) return nullptr;
    std::vector<std::string> words = {no_frames};
    for (const FrameFormat& format : formats) {
        if (format.word == word) return format.make(cast);
        words.push_back(format.word);
    }
    throw SceneError("output.frames: no such frame format: '" + word + "'; valid: " + joined(words));
}

}  // namespace

FrameWriter::FrameWriter(const std::string& folder, const Scene& scene, std::span<const FrameFormat> formats)
    : folder_(folder),
      formats_(formats),
      cast_(cast_of(scene)),
      files_(folder),
      encoder_(encoder_of(scene.output.frames, cast_, formats)) {
    const std::string& word = scene.output.frames;
    const bool holds = std::ranges::any_of(formats_, [&](const FrameFormat& f) { return f.word == word && f.holds_fields; });
    if (scene.output.fields.empty() || word == no_frames || holds) return;
    throw SceneError("output.fields: output.frames = \"" + word + "\" holds no fields; with them it must be one of " +
                     words_with_fields(formats_));
}

FrameRecord FrameWriter::write(const Frame& frame) {
    FrameRecord record{frame.index, frame.time, {}, {}, frame.check, {}};
    if (!encoder_) return record;
    const FrameFiles files = encoder_->write({frame.index, frame.time, frame.cloths, frame.obstacles, frame.fields}, files_);
    files_.check();
    record.cloths = files.cloths;
    record.obstacles = files.obstacles;
    if (!record.cloths.empty()) record.meeting = frame.meeting;
    return record;
}

void FrameWriter::finish(std::span<const double> times) {
    if (encoder_) encoder_->finish(times, files_);
    files_.finish();
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
