#include "common/finding.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "common/scene_file_error.h"

namespace percale::scenes {

const char* severity_word(Severity severity) {
    if (severity == Severity::error) return "error";
    return severity == Severity::warning ? "warning" : "note";
}

const char* role_word(MeshRole role) { return role == MeshRole::cloth ? "cloth" : "obstacle"; }

Finding finding(const std::string& kind, const SourcePlace& place, const std::string& what, const std::string& fix,
                Severity severity) {
    return {.severity = severity, .kind = kind, .place = place_text(place), .what = what, .fix = fix};
}

Finding refusal(const std::string& kind, const SceneError& error, const std::string& file, const std::string& fix) {
    const auto* placed = dynamic_cast<const SceneFileError*>(&error);
    const bool inside = (placed != nullptr ? placed->place().file : error.subject()) == file;
    return finding(kind, {inside ? error.subject() : file}, inside ? error.reason() : error.what(), fix, Severity::error);
}

long count_of(std::span<const Finding> findings, Severity severity) {
    return std::ranges::count(findings, severity, &Finding::severity);
}

void append_findings(std::vector<Finding> more, std::vector<Finding>& found) {
    std::move(more.begin(), more.end(), std::back_inserter(found));
}

std::string finding_text(const Finding& finding) {
    return finding.fix.empty() ? finding.what : finding.what + "; " + finding.fix;
}

std::vector<std::string> finding_texts(std::span<const Finding> findings) {
    std::vector<std::string> texts;
    for (const Finding& finding : findings) texts.push_back(finding_text(finding));
    return texts;
}

std::string finding_line(const Finding& finding) {
    return (finding.severity == Severity::note ? "" : std::string(severity_word(finding.severity)) + ": ") +
           finding_text(finding);
}

void print_finding(const Finding& finding) { std::printf("%s\n", finding_line(finding).c_str()); }

}  // namespace percale::scenes
