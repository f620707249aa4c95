#include "doctor/finding.h"

#include "common/scene_file_error.h"

namespace percale::scenes {

const char* severity_word(Severity severity) {
    if (severity == Severity::error) return "error";
    return severity == Severity::warning ? "warning" : "note";
}

const char* role_word(MeshRole role) { return role == MeshRole::cloth ? "cloth" : "obstacle"; }

Finding refusal(const std::string& kind, const SceneError& error, const std::string& file, const std::string& fix) {
    const auto* placed = dynamic_cast<const SceneFileError*>(&error);
    const bool inside = (placed != nullptr ? placed->place().file : error.subject()) == file;
    return {.severity = Severity::error,
            .kind = kind,
            .place = inside ? error.subject() : file,
            .what = inside ? error.reason() : error.what(),
            .fix = fix};
}

}  // namespace percale::scenes
