#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/source_place.h"
#include "percale/error.h"

// What users are told of a scene, a mesh or a run beside its figures.
namespace percale::scenes {

enum class Severity {
    note,     // worth knowing
    warning,  // will probably go wrong, or not be what was meant
    error,    // will be refused, or fail
};
const char* severity_word(Severity severity);

enum class MeshRole { cloth, obstacle };
const char* role_word(MeshRole role);

struct Finding {
    Severity severity = Severity::warning;
    std::string kind = {};              // a short name that stays the same: flat_triangles
    std::optional<MeshRole> role = {};  // what a mesh was looked at as
    std::string place = {};             // file:line:column, or the file
    std::string what = {};              // a sentence that names its subject, with numbers of a few elements
    std::string fix = {};               // one sentence; "" where there is none
    long count = 0;                     // elements concerned; 0 where it is not about elements
    std::vector<int> elements = {};     // the first of them: vertices, triangles, or vertices of edges two by two
};

/// A finding that is not about elements of a mesh.
Finding finding(const std::string& kind, const SourcePlace& place, const std::string& what, const std::string& fix = {},
                Severity severity = Severity::warning);

/// An error as a finding: at its place, where that is in the file; else at the file, with all that it says.
Finding refusal(const std::string& kind, const SceneError& error, const std::string& file, const std::string& fix);

long count_of(std::span<const Finding> findings, Severity severity);
void append_findings(std::vector<Finding> more, std::vector<Finding>& found);

/// "WHAT; FIX", or "WHAT" where there is no fix.
std::string finding_text(const Finding& finding);
std::vector<std::string> finding_texts(std::span<const Finding> findings);

/// A finding as programs print it while they work, without its end of line: "warning: WHAT; FIX"; a note without its severity.
std::string finding_line(const Finding& finding);
void print_finding(const Finding& finding);

}  // namespace percale::scenes
