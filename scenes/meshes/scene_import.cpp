#include "meshes/scene_import.h"

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_map>

#include "meshes/mesh_part.h"
#include "meshes/polygon.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

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

/// How often a file places its parts is not bounded by its size: vertices allowed.
std::size_t most_vertices(const aiScene& scene) {
    std::size_t own = 0;
    for (unsigned k = 0; k < scene.mNumMeshes; ++k) own += scene.mMeshes[k]->mNumVertices;
    return std::max(always_allowed_vertices, most_part_copies * own);
}

/// Joins the meshes of a scene's nodes.
class SceneJoin {
public:
    SceneJoin(ImportedScene& imported, const std::string& file, const std::string& part)
        : imported_(imported), file_(file), part_(part), most_(most_vertices(*imported.scene)) {}

    void join() {
        add(*imported_.scene->mRootNode, aiMatrix4x4(), 0);
        if (imported_.mesh.triangles.empty() && !part_.empty()) names_.fail(file_, part_);
    }

private:
    void add(const aiNode& node, const aiMatrix4x4& parent, int depth) {
        if (depth > deepest_node)
            throw SceneError(file_, "its nodes are nested more than " + std::to_string(deepest_node) + " deep");
        const aiMatrix4x4 to_world = parent * node.mTransformation;
        for (unsigned k = 0; k < node.mNumMeshes; ++k) {
            const aiMesh& one = *imported_.scene->mMeshes[node.mMeshes[k]];
            const std::string node_name = node.mName.C_Str(), mesh_name = one.mName.C_Str();
            for (const std::string& name : {node_name, mesh_name}) names_.add(name);
            if (part_.empty() || part_ == node_name || part_ == mesh_name) append(one, node, to_world);
        }
        if (imported_.mesh.vertices.size() > most_)
            throw SceneError(file_,
                             "copies of its parts come to more than " + std::to_string(most_) + " vertices; leave some out");
        for (unsigned k = 0; k < node.mNumChildren; ++k) add(*node.mChildren[k], to_world, depth + 1);
    }

    /// Appends one mesh with its node's transform.
    void append(const aiMesh& part, const aiNode& node, const aiMatrix4x4& to_world) {
        if ((part.mPrimitiveTypes & (aiPrimitiveType_TRIANGLE | aiPrimitiveType_POLYGON)) == 0) return;
        const std::size_t first = imported_.mesh.vertices.size();
        if (first + part.mNumVertices > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            throw SceneError(file_, "more vertices than an index can name");
        for (unsigned k = 0; k < part.mNumVertices; ++k) {
            const aiVector3D raw = part.mVertices[k], x = to_world * raw;
            check_finite({raw.x, raw.y, raw.z}, first + k, file_);
            imported_.mesh.vertices.emplace_back(x.x, x.y, x.z);
            imported_.origins.push_back({&node, &part, k});
        }
        for (unsigned k = 0; k < part.mNumFaces; ++k) append_face(part, k, first, file_, imported_.mesh);
    }

    ImportedScene& imported_;
    const std::string &file_, &part_;
    std::size_t most_;
    PartNames names_;
};

struct PositionHash {
    std::size_t operator()(const std::array<double, 3>& x) const {
        std::size_t hash = 0;
        for (const double number : x) hash = (hash ^ std::hash<double>{}(number)) * 0x9e3779b97f4a7c15ull;
        return hash ^ hash >> 32;
    }
};

}  // namespace

void check_finite(const Vec3& x, std::size_t vertex, const std::string& file) {
    constexpr const char* names[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(x[axis]))
            throw SceneError(file, "vertex " + std::to_string(vertex) + ": coordinate " + names[axis] + " is not finite");
}

ImportedScene import_scene(const std::string& file, const std::string& part) {
    ImportedScene imported{.importer = std::make_shared<Assimp::Importer>(), .scene = nullptr, .mesh = {}, .origins = {}};
    try {
        imported.scene = imported.importer->ReadFile(file, 0);
    } catch (const std::exception& error) {
        throw SceneError(file, std::string("cannot be imported: ") + error.what());
    }
    if (imported.scene == nullptr)
        throw SceneError(file, std::string("cannot be imported: ") + imported.importer->GetErrorString());
    if (imported.scene->mRootNode == nullptr) throw SceneError(file, "no vertices");
    SceneJoin(imported, file, part).join();
    return imported;
}

void weld(ImportedScene& imported, const std::function<bool(int vertex, int first)>& alike) {
    TriangleMesh mesh;
    std::vector<VertexOrigin> origins;
    std::unordered_map<std::array<double, 3>, std::vector<std::pair<int, int>>, PositionHash> known;  // first ones: old, new
    std::vector<int> welded(imported.mesh.vertices.size());
    for (std::size_t k = 0; k < welded.size(); ++k) {
        const int vertex = static_cast<int>(k);
        const Vec3 x = imported.mesh.vertices[k] + Vec3::Zero();  // -0 becomes +0
        auto& firsts = known[{x[0], x[1], x[2]}];
        const auto same = std::ranges::find_if(firsts, [&](const auto& first) { return !alike || alike(vertex, first.first); });
        if (same != firsts.end()) {
            welded[k] = same->second;
            continue;
        }
        welded[k] = static_cast<int>(mesh.vertices.size());
        firsts.emplace_back(vertex, welded[k]);
        mesh.vertices.push_back(imported.mesh.vertices[k]);
        origins.push_back(imported.origins[k]);
    }
    for (const Triangle& t : imported.mesh.triangles) mesh.triangles.push_back({welded[t[0]], welded[t[1]], welded[t[2]]});
    imported.mesh = std::move(mesh);
    imported.origins = std::move(origins);
}

std::vector<std::string> clip_names(const ImportedScene& imported) {
    std::vector<std::string> names;
    for (unsigned k = 0; k < imported.scene->mNumAnimations; ++k) {
        const std::string name = imported.scene->mAnimations[k]->mName.C_Str();
        names.push_back(name.empty() ? std::to_string(k) : name);
    }
    return names;
}

}  // namespace percale::scenes
