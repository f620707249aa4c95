#include "export/reference_files.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/input_file.h"
#include "common/scene_file_error.h"
#include "format/expectations.h"
#include "garment/cloth_shape.h"
#include "meshes/mesh_import.h"
#include "meshes/obj_file.h"
#include "meshes/ply_output.h"

namespace percale::scenes {

namespace {

struct ReferenceFile {
    const Expectation* expectation = nullptr;
    std::string file;
    TriangleMesh mesh;
};

/// All cloths as one mesh, at the end.
TriangleMesh cloths_at_end(const BuiltScene& built) {
    TriangleMesh all;
    for (std::size_t i = 0; i < built.cloths.size(); ++i) {
        const int first = static_cast<int>(all.vertices.size());
        const std::span<const Vec3> positions = built.simulation.positions(built.cloths[i]);
        all.vertices.insert(all.vertices.end(), positions.begin(), positions.end());
        for (const auto& [a, b, c] : built.cloth_meshes[i].triangles) all.triangles.push_back({first + a, first + b, first + c});
    }
    return all;
}

ReferenceFile reference_file(const BuiltScene& built, const RunResult& result, std::size_t index) {
    const Expectation& expectation = built.scene.expectations[index];
    ReferenceFile reference{&expectation, path_beside(built.scene, expectation.file), cloths_at_end(built)};
    const std::string ending = extension_of(reference.file);
    if (ending != ".obj" && ending != ".ply")
        fail_at(expectation.place, "matches: " + reference.file + ": --update writes .obj and .ply");
    if (expectation.during) fail_at(expectation.place, "matches during a time is of many shapes: --update cannot write one");
    if (!expectation.at) return reference;
    if (result.shapes.at(index).empty())
        fail_at(expectation.place,
                "matches: the run did not reach" + when_text(expectation).substr(3) + ", so there is no shape of then");
    reference.mesh.vertices = result.shapes[index];
    return reference;
}

std::string text_now(const std::string& file) { return std::filesystem::exists(file) ? read_text(file) : ""; }

}  // namespace

std::vector<std::string> update_references(const BuiltScene& built, const RunResult& result) {
    std::vector<ReferenceFile> files;
    for (std::size_t i = 0; i < built.scene.expectations.size(); ++i) {
        const Expectation& expectation = built.scene.expectations[i];
        if (expectation.measure != "matches") continue;
        ReferenceFile reference = reference_file(built, result, i);
        if (std::ranges::find(files, reference.file, &ReferenceFile::file) != files.end())
            fail_at(expectation.place, "matches: " + reference.file + " is named twice, and --update cannot write both into it");
        files.push_back(std::move(reference));
    }
    std::vector<std::string> reported;
    for (const ReferenceFile& reference : files) {
        const std::string before = text_now(reference.file);
        if (extension_of(reference.file) == ".ply")
            write_ply(reference.file, reference.mesh);
        else
            write_obj(reference.file, reference.mesh.vertices, reference.mesh.triangles);
        const bool same = before == text_now(reference.file);
        reported.push_back("matches " + reference.expectation->file + when_text(*reference.expectation) + ": " +
                           (same ? "unchanged" : "written, " + std::to_string(reference.mesh.vertices.size()) + " vertices"));
    }
    return reported;
}

}  // namespace percale::scenes
