#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "common/finding.h"
#include "format/override.h"

// What will go wrong with a scene or a mesh, found without taking a step.
namespace percale::scenes {

struct Diagnosis {
    std::string file;
    std::vector<Finding> findings;  // errors first

    long count(Severity severity) const { return count_of(findings, severity); }
    bool has(const std::string& kind) const { return std::ranges::find(findings, kind, &Finding::kind) != findings.end(); }
};

struct DoctorSettings {
    std::optional<MeshRole> role = {};     // of a mesh file; both if not said
    std::vector<Override> overrides = {};  // of a scene file
};

/// The scene files and mesh files of a folder itself, by name. Throws SceneError where there is none.
std::vector<std::string> examinable_files(const std::string& folder);

/// Looks at a file: a scene if its name ends in .toml, else a mesh. What is wrong inside the file is a finding; throws SceneError
/// only where there is no such file, or for an override that is wrong.
Diagnosis diagnose(const std::string& file, const DoctorSettings& settings = {});

}  // namespace percale::scenes
