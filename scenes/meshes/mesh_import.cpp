#include "meshes/mesh_import.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <optional>

#include "common/input_file.h"
#include "common/text.h"
#include "meshes/near_vertices.h"
#include "meshes/obj_file.h"
#include "meshes/off_file.h"
#include "meshes/ply_file.h"
#include "meshes/stl_header.h"
#include "models/joined_model.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

/// The extension in lower case; for one that is none of our own, what the file's first word gives away, since assimp would go by
/// that, too.
std::string format_of(const std::string& file) {
    const std::string extension = extension_of(file);
    if (extension == ".obj" || extension == ".off" || extension == ".ply" || extension == ".stl") return extension;
    std::ifstream in(file, std::ios::binary);
    std::string word;
    in >> std::setw(8) >> word;
    if (word == "OFF" || word == "COFF" || word == "NOFF" || word == "CNOFF") return ".off";
    return word == "ply" ? ".ply" : extension;
}

/// Our own formats and those of meshes that assimp reads in proportion to the file. Not those of scenes that it tessellates or
/// unpacks to any size, nor raw triangles, on which its reader crashes.
const std::vector<std::string>& read_formats() {
    static const std::vector<std::string> read = {".obj", ".off", ".ply", ".stl", ".gltf", ".glb", ".dae", ".fbx",
                                                  ".3ds", ".amf", ".x3d", ".dxf", ".lwo",  ".ase", ".x"};
    return read;
}

bool is_read(const std::string& format) {
    return std::find(read_formats().begin(), read_formats().end(), format) != read_formats().end();
}

void check_format(const std::string& file, const std::string& format) {
    if (!is_read(format)) throw SceneError(file, "is of no format that is read: " + joined(read_formats()));
}

void check_mesh_file(const std::string& file) {
    std::error_code status;
    if (!std::filesystem::exists(file, status)) throw SceneError(file, "no such file");
    if (!std::filesystem::is_regular_file(file, status)) throw SceneError(file, "not a file");
    if (std::filesystem::file_size(file, status) == 0) throw SceneError(file, "no vertices: the file is empty");
}

template <class Read>
auto read_with(Read read, const std::string& file) {
    std::ifstream in = open_input(file);
    if (!in) throw SceneError(file, std::string("cannot be read: ") + std::strerror(errno));
    std::string start(4, '\0');
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    in.clear();
    in.seekg(static_cast<std::streamoff>(encoding_mark(start, file)));
    return read(in, file);
}

/// Reads a file by our own reader; nothing for the format of a model.
std::optional<TriangleMesh> read_own(const std::string& format, const std::string& file, const std::string& part) {
    if (format == ".obj") {
        return read_with([&](std::istream& in, const std::string& name) { return read_obj(in, name, part); }, file);
    }
    const bool has_parts = format != ".off" && format != ".ply" && format != ".stl";
    if (!part.empty() && !has_parts) throw SceneError(file, "has no objects or groups, so none named '" + part + "'");
    if (format == ".off") return read_with(read_off, file);
    if (format == ".ply") return read_with([](std::istream& in, const std::string& name) { return read_ply(in, name); }, file);
    return std::nullopt;
}

/// Reads a file in the format of a model.
TriangleMesh read_model(const std::string& file, std::vector<Finding>* warnings, const std::string& part) {
    JoinedModel model = read_joined_model(file, part);
    weld(model);
    const std::vector<std::string> clips = clip_names(model.model);
    if (!clips.empty() && warnings != nullptr) {
        warnings->push_back(finding("left_out", {file},
                                    file + ": it is animated, which is left out: the mesh is as it stands in the file",
                                    "an obstacle's clip plays one of: " + joined(clips)));
    }
    return std::move(model.mesh);
}

TriangleMesh welded(const TriangleMesh& mesh, double distance, const std::string& file, std::vector<Finding>* warnings) {
    WeldedMesh near = weld_near(mesh, distance);
    const std::string what = "weld = " + short_number(distance) + " m ";
    if (near.mesh.triangles.empty()) throw SceneError(file, what + "leaves no triangle: all are smaller");
    const auto warn = [&](const char* kind, const std::string& effect) {
        if (warnings != nullptr) warnings->push_back(finding(kind, {file}, file + ": " + what + effect));
    };
    if (near.joined_vertices == 0) warn("weld_joins_nothing", "joins nothing: no two vertices are so near");
    if (near.dropped_triangles > 0)
        warn("weld_drops_triangles",
             "leaves out " + counted(near.dropped_triangles, "triangle") + " of which two corners become one");
    return std::move(near.mesh);
}

}  // namespace

std::string extension_of(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& letter : extension) letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    return extension;
}

bool is_mesh_file(const std::string& file) { return is_read(extension_of(file)); }

TriangleMesh import_mesh(const std::string& file, double unit, std::vector<Finding>* warnings, const std::string& part,
                         double weld) {
    if (!std::isfinite(unit) || unit <= 0.0) throw SceneError(file, "unit is " + std::to_string(unit) + ", must be above 0");
    check_mesh_file(file);
    const std::string format = format_of(file);
    check_format(file, format);
    if (format == ".stl") check_stl_header(file);
    std::optional<TriangleMesh> own = read_own(format, file, part);
    TriangleMesh mesh = own ? std::move(*own) : read_model(file, warnings, part);
    if (mesh.triangles.empty()) throw SceneError(file, "no triangles");
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) check_finite(mesh.vertices[k] *= unit, k, file);
    return weld > 0.0 ? welded(mesh, weld, file, warnings) : mesh;
}

TriangleMesh import_mesh_with_fields(const std::string& file, std::vector<MeshField>& fields) {
    fields.clear();
    check_mesh_file(file);
    const std::string format = format_of(file);
    if (format != ".ply") {
        if (format != ".obj") throw SceneError(file, "is neither PLY nor OBJ");
        return import_mesh(file);
    }
    TriangleMesh mesh = read_with([&](std::istream& in, const std::string& name) { return read_ply(in, name, &fields); }, file);
    if (mesh.triangles.empty()) throw SceneError(file, "no triangles");
    return mesh;
}

TexturedMesh import_textured_mesh(const std::string& file, double unit, const std::string& part) {
    check_mesh_file(file);
    if (format_of(file) != ".obj") throw SceneError(file, "has no vt, which are read from OBJ files");
    TexturedMesh textured =
        read_with([&](std::istream& in, const std::string& name) { return read_textured_obj(in, name, part); }, file);
    for (Vec3& x : textured.mesh.vertices) x *= unit;
    return textured;
}

}  // namespace percale::scenes
