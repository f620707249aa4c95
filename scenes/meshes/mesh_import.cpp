#include "meshes/mesh_import.h"

#include <assimp/scene.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>

#include "common/text.h"
#include "meshes/mesh_part.h"
#include "meshes/obj_file.h"
#include "meshes/off_file.h"
#include "meshes/ply_file.h"
#include "meshes/polygon.h"
#include "meshes/stl_header.h"
#include "percale/error.h"
#include "tolerances.h"

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
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) throw SceneError(file, std::string("cannot be read: ") + std::strerror(errno));
    return read(in, file);
}

/// By our own reader; nothing where assimp reads the format.
std::optional<TriangleMesh> read_own(const std::string& format, const std::string& file, const std::string& part) {
    if (format == ".obj") {
        return read_with([&](std::istream& in, const std::string& name) { return read_obj(in, name, part); }, file);
    }
    const bool has_parts = format != ".off" && format != ".ply" && format != ".stl";
    if (!part.empty() && !has_parts) throw SceneError(file, "has no objects or groups, so none named '" + part + "'");
    if (format == ".off") return read_with(read_off, file);
    if (format == ".ply") return read_with(read_ply, file);
    return std::nullopt;
}

template <typename Point>
void check_finite(const Point& x, std::size_t vertex, const std::string& file) {
    constexpr const char* names[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(x[axis]))
            throw SceneError(file, "vertex " + std::to_string(vertex) + ": coordinate " + names[axis] + " is not finite");
}

/// Points and lines give nothing. assimp's own way to triangles follows indices that are out
/// of range, and ends the program where a polygon has no area.
void append_face(const aiMesh& part, unsigned number, std::size_t first, const std::string& file, TriangleMesh& mesh) {
    const std::span<const unsigned> indices(part.mFaces[number].mIndices, part.mFaces[number].mNumIndices);
    for (const unsigned index : indices) {
        if (index < part.mNumVertices) continue;
        throw SceneError(file, "face " + std::to_string(number) + ": vertex index " + std::to_string(index) +
                                   " is out of range 0 ... " + std::to_string(static_cast<long>(part.mNumVertices) - 1));
    }
    std::vector<Vec3> places;
    for (const unsigned index : indices) places.push_back(mesh.vertices[first + index]);
    const auto corner = [&](int k) { return static_cast<int>(first + indices[static_cast<std::size_t>(k)]); };
    for (const Triangle& t : polygon_triangles(places)) mesh.triangles.push_back({corner(t[0]), corner(t[1]), corner(t[2])});
}

/// Appends one mesh of an imported scene with its node's transform.
void append(const aiMesh& part, const aiMatrix4x4& to_world, const std::string& file, TriangleMesh& mesh) {
    if ((part.mPrimitiveTypes & (aiPrimitiveType_TRIANGLE | aiPrimitiveType_POLYGON)) == 0) return;
    const std::size_t first = mesh.vertices.size();
    if (first + part.mNumVertices > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw SceneError(file, "more vertices than an index can name");
    for (unsigned k = 0; k < part.mNumVertices; ++k) {
        check_finite(part.mVertices[k], first + k, file);
        const aiVector3D x = to_world * part.mVertices[k];
        mesh.vertices.emplace_back(x.x, x.y, x.z);
    }
    for (unsigned k = 0; k < part.mNumFaces; ++k) append_face(part, k, first, file, mesh);
}

/// How often a file places its parts is not bounded by its size: vertices allowed.
std::size_t most_vertices(const aiScene& scene) {
    std::size_t own = 0;
    for (unsigned k = 0; k < scene.mNumMeshes; ++k) own += scene.mMeshes[k]->mNumVertices;
    return std::max(always_allowed_vertices, most_part_copies * own);
}

/// Joins the meshes of a scene's nodes.
class SceneJoin {
public:
    SceneJoin(const aiScene& scene, const std::string& file, const std::string& part)
        : scene_(scene), file_(file), part_(part), most_(most_vertices(scene)) {}

    TriangleMesh join() {
        add(*scene_.mRootNode, aiMatrix4x4());
        if (mesh_.triangles.empty() && !part_.empty()) names_.fail(file_, part_);
        return std::move(mesh_);
    }

private:
    void add(const aiNode& node, const aiMatrix4x4& parent) {
        const aiMatrix4x4 to_world = parent * node.mTransformation;
        for (unsigned k = 0; k < node.mNumMeshes; ++k) {
            const aiMesh& one = *scene_.mMeshes[node.mMeshes[k]];
            const std::string node_name = node.mName.C_Str(), mesh_name = one.mName.C_Str();
            for (const std::string& name : {node_name, mesh_name}) names_.add(name);
            if (part_.empty() || part_ == node_name || part_ == mesh_name) append(one, to_world, file_, mesh_);
        }
        if (mesh_.vertices.size() > most_)
            throw SceneError(file_,
                             "copies of its parts come to more than " + std::to_string(most_) + " vertices; leave some out");
        for (unsigned k = 0; k < node.mNumChildren; ++k) add(*node.mChildren[k], to_world);
    }

    const aiScene& scene_;
    const std::string &file_, &part_;
    std::size_t most_;
    PartNames names_;
    TriangleMesh mesh_;
};

struct PositionHash {
    std::size_t operator()(const std::array<double, 3>& x) const {
        std::size_t hash = 0;
        for (const double number : x) hash = (hash ^ std::hash<double>{}(number)) * 0x9e3779b97f4a7c15ull;
        return hash ^ hash >> 32;
    }
};

/// Vertices at the same place become one, at the first one's position in the order: exporters split vertices at seams of texture
/// or shading, and STL shares none.
TriangleMesh weld(const TriangleMesh& split) {
    TriangleMesh mesh;
    std::unordered_map<std::array<double, 3>, int, PositionHash> known;
    std::vector<int> welded(split.vertices.size());
    for (std::size_t k = 0; k < split.vertices.size(); ++k) {
        const Vec3 x = split.vertices[k] + Vec3::Zero();  // -0 becomes +0
        const auto [entry, is_new] = known.try_emplace({x[0], x[1], x[2]}, static_cast<int>(mesh.vertices.size()));
        if (is_new) mesh.vertices.push_back(split.vertices[k]);
        welded[k] = entry->second;
    }
    for (const Triangle& t : split.triangles) mesh.triangles.push_back({welded[t[0]], welded[t[1]], welded[t[2]]});
    return mesh;
}

/// Reads the mesh as it stands in the file.
TriangleMesh read_with_assimp(const std::string& file, std::vector<std::string>* warnings, const std::string& part) {
    Assimp::Importer importer;
    const aiScene* scene = nullptr;
    try {
        scene = importer.ReadFile(file, 0);
    } catch (const std::exception& error) {
        throw SceneError(file, std::string("cannot be imported: ") + error.what());
    }
    if (scene == nullptr) throw SceneError(file, std::string("cannot be imported: ") + importer.GetErrorString());
    if (scene->mRootNode == nullptr) throw SceneError(file, "no vertices");
    TriangleMesh mesh = SceneJoin(*scene, file, part).join();
    if (scene->HasAnimations() && warnings != nullptr) {
        warnings->push_back(file + ": it is animated, which is left out: the mesh is as it stands in the file");
    }
    return mesh;
}

}  // namespace

std::string extension_of(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& letter : extension) letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    return extension;
}

bool is_mesh_file(const std::string& file) { return is_read(extension_of(file)); }

TriangleMesh import_mesh(const std::string& file, double unit, std::vector<std::string>* warnings, const std::string& part) {
    if (!std::isfinite(unit) || unit <= 0.0) throw SceneError(file, "unit is " + std::to_string(unit) + ", must be above 0");
    check_mesh_file(file);
    const std::string format = format_of(file);
    check_format(file, format);
    if (format == ".stl") check_stl_header(file);
    std::optional<TriangleMesh> own = read_own(format, file, part);
    TriangleMesh mesh = own ? std::move(*own) : read_with_assimp(file, warnings, part);
    if (mesh.triangles.empty()) throw SceneError(file, "no triangles");
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) check_finite(mesh.vertices[k] *= unit, k, file);
    return own ? mesh : weld(mesh);
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
