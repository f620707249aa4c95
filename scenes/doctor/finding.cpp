#include "doctor/finding.h"

namespace percale::scenes {

const char* severity_word(Severity severity) {
    if (severity == Severity::error) return "error";
    return severity == Severity::warning ? "warning" : "note";
}

const char* role_word(MeshRole role) { return role == MeshRole::cloth ? "cloth" : "obstacle"; }

Finding refusal(const std::string& kind, const std::string& message, const std::string& file, const std::string& fix) {
    Finding finding{.severity = Severity::error, .kind = kind, .place = file, .what = message, .fix = fix};
    const std::size_t end = message.starts_with(file + ":") ? message.find(": ", file.size()) : std::string::npos;
    if (end == std::string::npos) return finding;
    finding.place = message.substr(0, end);
    finding.what = message.substr(end + 2);
    return finding;
}

}  // namespace percale::scenes
