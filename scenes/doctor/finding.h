#pragma once

#include <optional>
#include <string>
#include <vector>

#include "percale/error.h"

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
    Severity severity = Severity::note;
    std::string kind = {};              // a short name that stays the same: flat_triangles
    std::optional<MeshRole> role = {};  // what a mesh was looked at as
    std::string place = {};             // file:line:column, or the file
    std::string what = {};              // with numbers of a few elements
    std::string fix = {};               // one sentence
    long count = 0;                     // elements concerned; 0 where it is not about elements
    std::vector<int> elements = {};     // the first of them: vertices, triangles, or vertices of edges two by two
};

/// An error as a finding: at its place, where that is in the file; else at the file, with all that it says.
Finding refusal(const std::string& kind, const SceneError& error, const std::string& file, const std::string& fix);

}  // namespace percale::scenes
