#include "doctor/doctor_report.h"

#include "common/finding_json.h"
#include "common/text.h"

namespace percale::scenes {

using nlohmann::ordered_json;

namespace {

/// As findings are everywhere, and of a mesh what it was looked at as, with its elements.
ordered_json finding_object(const Finding& finding) {
    ordered_json json = finding;
    json["as"] = finding.role ? ordered_json(role_word(*finding.role)) : ordered_json(nullptr);
    json["count"] = finding.count;
    json["elements"] = finding.elements;
    return json;
}

std::string counts_text(const Diagnosis& diagnosis) {
    if (diagnosis.findings.empty()) return diagnosis.file + ": nothing found";
    return diagnosis.file + ": " + counted(diagnosis.count(Severity::error), "error") + ", " +
           counted(diagnosis.count(Severity::warning), "warning") + ", " + counted(diagnosis.count(Severity::note), "note");
}

}  // namespace

std::string diagnosis_line(const Diagnosis& diagnosis) {
    if (diagnosis.findings.empty()) return counts_text(diagnosis) + "\n";
    const Finding& worst = diagnosis.findings.front();
    const std::string use = worst.role ? std::string("as ") + role_word(*worst.role) + ": " : "";
    return counts_text(diagnosis) + "; " + use + worst.what + "\n";
}

std::string diagnosis_text(const Diagnosis& diagnosis) {
    if (diagnosis.findings.empty()) return counts_text(diagnosis) + "\n";
    std::string text;
    for (const Finding& finding : diagnosis.findings) {
        const bool bare = finding.role && finding.place == diagnosis.file;
        const std::string use = bare ? std::string("as ") + role_word(*finding.role) + ": " : "";
        text += finding.place + ": " + severity_word(finding.severity) + ": " + use + finding.what + "\n";
        if (!finding.fix.empty()) text += "    fix: " + finding.fix + "\n";
    }
    return text + counts_text(diagnosis) + "\n";
}

std::string diagnoses_json(std::span<const Diagnosis> diagnoses) {
    ordered_json json;
    json["files"] = ordered_json::array();
    for (const Diagnosis& diagnosis : diagnoses) {
        ordered_json file = {{"file", diagnosis.file},
                             {"errors", diagnosis.count(Severity::error)},
                             {"warnings", diagnosis.count(Severity::warning)},
                             {"notes", diagnosis.count(Severity::note)}};
        file["findings"] = ordered_json::array();
        for (const Finding& finding : diagnosis.findings) file["findings"].push_back(finding_object(finding));
        json["files"].push_back(file);
    }
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace percale::scenes
