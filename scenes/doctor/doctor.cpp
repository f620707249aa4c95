#include "doctor/doctor.h"

#include <algorithm>
#include <filesystem>
#include <functional>

#include "doctor/doctor_mesh.h"
#include "doctor/doctor_scene.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

void check_is_file(const std::string& file) {
    std::error_code status;
    if (!std::filesystem::exists(file, status)) throw SceneError(file + ": no such file");
    if (!std::filesystem::is_regular_file(file, status)) throw SceneError(file + ": not a file");
}

std::vector<Finding> examine_mesh(const std::string& file, MeshRole role, TriangleMesh mesh) {
    ExaminedMesh examined{.role = role, .place = file, .mesh = std::move(mesh)};
    examined.facts = facts_as(role, examined.mesh);
    return role == MeshRole::cloth ? examine_cloth(examined, Fabric{}) : examine_obstacle(examined);
}

std::vector<Finding> examine_mesh_file(const std::string& file, std::optional<MeshRole> asked) {
    std::vector<Finding> found;
    try {
        const TriangleMesh mesh = import_mesh(file, 1.0, &found);
        for (Finding& animation : found) {
            animation.what = finding_text(animation).substr(file.size() + 2);
            animation.fix = "export the frame that is meant as a mesh that does not move";
        }
        check_mesh(mesh, file, false);
        for (const MeshRole role : {MeshRole::cloth, MeshRole::obstacle}) {
            if (!asked || *asked == role) append_findings(examine_mesh(file, role, mesh), found);
        }
    } catch (const SceneError& error) {
        found.push_back(refusal("unreadable", error, file,
                                "export the mesh again, as OBJ, OFF, PLY or STL, with triangles and finite coordinates"));
    }
    return found;
}

}  // namespace

std::vector<std::string> examinable_files(const std::string& folder) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string file = entry.path().string();
        if (entry.is_regular_file() && (extension_of(file) == ".toml" || is_mesh_file(file))) files.push_back(file);
    }
    if (files.empty()) throw SceneError(folder + ": no scene file and no mesh file in this folder");
    std::ranges::sort(files);
    return files;
}

Diagnosis diagnose(const std::string& file, const DoctorSettings& settings) {
    check_is_file(file);
    Diagnosis diagnosis{.file = file,
                        .findings = extension_of(file) == ".toml" ? examine_scene_file(file, settings.overrides)
                                                                  : examine_mesh_file(file, settings.role)};
    std::ranges::stable_sort(diagnosis.findings, std::ranges::greater(), &Finding::severity);
    return diagnosis;
}

}  // namespace percale::scenes
