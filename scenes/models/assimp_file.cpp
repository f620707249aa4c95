#include "models/assimp_file.h"

#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <map>
#include <new>
#include <span>

#include "models/limited_child.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

/// Nodes of a file inside each other. More: the stack overflows.
constexpr int deepest_node = 1000;

/// What an importer of assimp may use for a file: bytes of memory, and so many for each byte of the file; s of CPU time,
/// likewise. Less: large good files are refused. More: broken ones take the machine longer.
constexpr std::uint64_t import_memory = 512ull << 20, import_memory_per_byte = 64;
constexpr double import_cpu_s = 10.0, import_cpu_s_per_byte = 2e-6;

/// Ticks a second of a clip that does not say, 1/s: frames of a film, what files mean that do not.
constexpr double usual_ticks_per_s = 25.0;

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
    Eigen::Matrix4d result;
    for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column) result(row, column) = m[row][column];
    return result;
}

std::vector<Vec3> places(const aiVector3D* vertices, unsigned count) {
    std::vector<Vec3> result;
    result.reserve(count);
    for (unsigned k = 0; k < count; ++k) result.emplace_back(vertices[k].x, vertices[k].y, vertices[k].z);
    return result;
}

/// A mesh of points and lines has no faces here.
ModelMesh mesh_of(const aiMesh& from) {
    ModelMesh mesh{.name = from.mName.C_Str(), .vertices = {}, .corners = {}, .face_sizes = {}, .shares = {}, .targets = {}};
    if ((from.mPrimitiveTypes & (aiPrimitiveType_TRIANGLE | aiPrimitiveType_POLYGON)) == 0) return mesh;
    mesh.vertices = places(from.mVertices, from.mNumVertices);
    for (const aiFace& face : std::span(from.mFaces, from.mNumFaces)) {
        mesh.face_sizes.push_back(static_cast<int>(face.mNumIndices));
        for (const unsigned index : std::span(face.mIndices, face.mNumIndices)) mesh.corners.push_back(static_cast<int>(index));
    }
    for (unsigned bone = 0; bone < from.mNumBones; ++bone)
        for (const aiVertexWeight& weight : std::span(from.mBones[bone]->mWeights, from.mBones[bone]->mNumWeights))
            mesh.shares.push_back({static_cast<int>(weight.mVertexId), static_cast<int>(bone), weight.mWeight});
    for (const aiAnimMesh* target : std::span(from.mAnimMeshes, from.mNumAnimMeshes))
        mesh.targets.push_back(
            {target->HasPositions() ? places(target->mVertices, target->mNumVertices) : std::vector<Vec3>(), target->mWeight});
    return mesh;
}

template <class Key>
void add_key(const Key& key, const std::array<double, 4>& value, ModelTrack& track) {
    track.times.push_back(key.mTime);
    track.values.push_back(value);
}

ModelTrack track_of(std::span<const aiVectorKey> keys) {
    ModelTrack track;
    for (const aiVectorKey& key : keys) add_key(key, {key.mValue.x, key.mValue.y, key.mValue.z, 0.0}, track);
    return track;
}

ModelTrack track_of(std::span<const aiQuatKey> keys) {
    ModelTrack track;
    for (const aiQuatKey& key : keys) add_key(key, {key.mValue.x, key.mValue.y, key.mValue.z, key.mValue.w}, track);
    return track;
}

/// What assimp has read, as plain values.
class Conversion {
public:
    Conversion(const aiScene& scene, const std::string& file) : scene_(scene), file_(file) {}

    Model convert() {
        if (scene_.mRootNode == nullptr) throw SceneError(file_, "no vertices");
        for (const aiMesh* mesh : std::span(scene_.mMeshes, scene_.mNumMeshes)) model_.meshes.push_back(mesh_of(*mesh));
        add_node(*scene_.mRootNode, -1, 0);
        for (unsigned k = 0; k < scene_.mNumMeshes; ++k) add_skin(*scene_.mMeshes[k], static_cast<int>(k));
        for (const aiAnimation* clip : std::span(scene_.mAnimations, scene_.mNumAnimations)) add_clip(*clip);
        return std::move(model_);
    }

private:
    void add_node(const aiNode& from, int parent, int depth) {
        if (depth > deepest_node)
            throw SceneError(file_, "its nodes are nested more than " + std::to_string(deepest_node) + " deep");
        const int number = static_cast<int>(model_.nodes.size());
        ModelNode node{
            .name = from.mName.C_Str(), .parent = parent, .transform = matrix(from.mTransformation), .parts = {}, .weights = {}};
        for (const unsigned mesh : std::span(from.mMeshes, from.mNumMeshes)) node.parts.push_back({static_cast<int>(mesh), -1});
        nodes_.emplace(node.name, number);
        model_.nodes.push_back(std::move(node));
        for (const aiNode* child : std::span(from.mChildren, from.mNumChildren)) add_node(*child, number, depth + 1);
    }

    /// The first node of that name.
    int node_of(const char* name, const char* whose) const {
        const auto found = nodes_.find(name);
        if (found == nodes_.end()) throw SceneError(file_, std::string(whose) + " '" + name + "' is no node");
        return found->second;
    }

    /// Adds the skin of a mesh, for all nodes that it hangs on.
    void add_skin(const aiMesh& mesh, int number) {
        if (mesh.mNumBones == 0) return;
        ModelSkin skin;
        for (const aiBone* bone : std::span(mesh.mBones, mesh.mNumBones)) {
            skin.joints.push_back(node_of(bone->mName.C_Str(), "bone"));
            skin.offsets.push_back(matrix(bone->mOffsetMatrix));
        }
        for (ModelNode& node : model_.nodes)
            for (ModelPart& part : node.parts)
                if (part.mesh == number) part.skin = static_cast<int>(model_.skins.size());
        model_.skins.push_back(std::move(skin));
    }

    void add_clip(const aiAnimation& from) {
        ModelClip clip{.name = from.mName.C_Str(),
                       .ticks_per_s = from.mTicksPerSecond > 0.0 ? from.mTicksPerSecond : usual_ticks_per_s,
                       .channels = {},
                       .morphs = {}};
        for (const aiNodeAnim* channel : std::span(from.mChannels, from.mNumChannels)) {
            const auto node = nodes_.find(channel->mNodeName.C_Str());
            if (node == nodes_.end()) continue;  // it moves nothing that is drawn
            clip.channels.push_back({.node = node->second,
                                     .translation = track_of(std::span(channel->mPositionKeys, channel->mNumPositionKeys)),
                                     .rotation = track_of(std::span(channel->mRotationKeys, channel->mNumRotationKeys)),
                                     .scale = track_of(std::span(channel->mScalingKeys, channel->mNumScalingKeys))});
        }
        for (const aiMeshMorphAnim* channel : std::span(from.mMorphMeshChannels, from.mNumMorphMeshChannels))
            clip.morphs.push_back(morphs_of(*channel));
        model_.clips.push_back(std::move(clip));
    }

    ModelMorphs morphs_of(const aiMeshMorphAnim& channel) const {
        const std::string name = channel.mName.C_Str();
        const std::string target = name.substr(0, name.find('*'));  // FBX: name*number
        ModelMorphs morphs;
        for (std::size_t k = 0; k < model_.nodes.size(); ++k) {
            const ModelNode& node = model_.nodes[k];
            const bool meant = node.name == target || std::ranges::any_of(node.parts, [&](const ModelPart& part) {
                                   return model_.meshes[static_cast<std::size_t>(part.mesh)].name == target;
                               });
            if (meant) morphs.nodes.push_back(static_cast<int>(k));
        }
        for (const aiMeshMorphKey& key : std::span(channel.mKeys, channel.mNumKeys)) {
            std::vector<double> weights;
            for (unsigned k = 0; k < key.mNumValuesAndWeights; ++k) {
                if (key.mValues[k] >= max_morph_targets) continue;
                weights.resize(std::max<std::size_t>(weights.size(), key.mValues[k] + 1));
                weights[key.mValues[k]] += key.mWeights[k];
            }
            morphs.times.push_back(key.mTime);
            morphs.weights.push_back(std::move(weights));
        }
        return morphs;
    }

    const aiScene& scene_;
    const std::string& file_;
    Model model_;
    std::map<std::string, int> nodes_;
};

Model import_here(const std::string& file) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(file, 0);
    const std::string fault = importer.GetErrorString();
    if (scene == nullptr && fault == std::bad_alloc().what()) throw std::bad_alloc();
    if (scene == nullptr) throw SceneError(file, "cannot be imported: " + fault);
    return Conversion(*scene, file).convert();
}

}  // namespace

Model read_by_assimp(const std::string& file) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error) throw SceneError(file, "cannot be read: " + error.message());
    const ChildLimits limits{.memory = import_memory + import_memory_per_byte * bytes,
                             .cpu_s = import_cpu_s + import_cpu_s_per_byte * static_cast<double>(bytes)};
    try {
        return model_of(run_in_child(limits, [&] { return bytes_of(import_here(file)); }));
    } catch (const SceneError& fault) {
        const std::string own = file + ": ";  // it was about the file's content
        if (fault.reason().starts_with(own)) throw SceneError(file, fault.reason().substr(own.size()));
        throw SceneError(file, "cannot be imported: " + fault.reason());
    }
}

}  // namespace percale::scenes
