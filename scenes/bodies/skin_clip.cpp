#include "bodies/skin_clip.h"

#include <assimp/scene.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <span>

#include "bodies/clip_keys.h"
#include "common/nearest_name.h"
#include "common/text.h"
#include "garment/cloth_shape.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
    Eigen::Matrix4d result;
    for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column) result(row, column) = m[row][column];
    return result;
}

Eigen::Vector4d point(const aiVector3D& x) { return {x.x, x.y, x.z, 1.0}; }

void check_can_be_animated(const std::string& file) {
    const std::vector<std::string> animated = {".gltf", ".glb", ".fbx", ".dae"};
    if (std::ranges::find(animated, extension_of(file)) == animated.end())
        throw SceneError(file, "has no clips, which are read from " + joined(animated));
    if (!std::filesystem::is_regular_file(file)) throw SceneError(file, "no such file");
}

/// By name, or else by number.
const aiAnimation& clip_named(const ImportedScene& imported, const std::string& clip, const std::string& file) {
    const std::vector<std::string> names = clip_names(imported);
    if (names.empty()) throw SceneError(file, "has no animations, so no clip '" + clip + "'");
    const auto found = std::ranges::find(names, clip);
    if (found != names.end()) return *imported.scene->mAnimations[found - names.begin()];
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(clip.data(), clip.data() + clip.size(), number);
    if (error != std::errc() || end != clip.data() + clip.size() || number >= names.size())
        throw SceneError(file, "has no clip '" + clip + "'" + suggestion(clip, names));
    return *imported.scene->mAnimations[number];
}

double last_tick(const aiAnimation& clip) {
    double last = 0.0;
    for (unsigned k = 0; k < clip.mNumChannels; ++k) last = std::max(last, last_key(*clip.mChannels[k]));
    for (unsigned k = 0; k < clip.mNumMorphMeshChannels; ++k) last = std::max(last, last_key(*clip.mMorphMeshChannels[k]));
    return last;
}

/// A vertex with its morph targets: x + sum of w (target - x).
Eigen::Vector4d morphed(const aiMesh& mesh, unsigned vertex, std::span<const std::pair<unsigned, double>> weights) {
    const Eigen::Vector4d own = point(mesh.mVertices[vertex]);
    Eigen::Vector4d x = own;
    for (const auto& [target, weight] : weights) {
        const aiAnimMesh& other = *mesh.mAnimMeshes[target];
        if (other.HasPositions() && vertex < other.mNumVertices) x += weight * (point(other.mVertices[vertex]) - own);
    }
    return x;
}

}  // namespace

SkinClip::SkinClip(const Scene& scene, const ObstacleSpec& obstacle)
    : file_(path_beside(scene, obstacle.mesh)), unit_(obstacle.unit) {
    check_can_be_animated(file_);
    if (obstacle.fps) throw SceneError(file_, "has its own times; fps is for frames and PC2 caches");
    imported_ = import_scene(file_, obstacle.part);
    if (imported_.mesh.triangles.empty()) throw SceneError(file_, "no triangles");
    clip_ = &clip_named(imported_, *obstacle.clip, file_);
    name_ = clip_->mName.length > 0 ? clip_->mName.C_Str() : *obstacle.clip;
    ticks_per_s_ = clip_->mTicksPerSecond > 0.0 ? clip_->mTicksPerSecond : usual_ticks_per_s;
    length_ = last_tick(*clip_) / ticks_per_s_;
    if (!(length_ > 0.0 && std::isfinite(length_)))
        throw SceneError(file_, "clip '" + name_ + "' has no two keys: nothing moves");
    add_joints(*imported_.scene->mRootNode, -1);
    add_skins();
    weld_alike();
    add_skins();
    mesh_ = {.vertices = shape({}), .triangles = imported_.mesh.triangles};
}

void SkinClip::add_skins() {
    skins_.clear();
    skin_of_.clear();
    for (const VertexOrigin& origin : imported_.origins) {
        const bool same =
            !skins_.empty() && skins_.back().mesh == origin.mesh && joints_[skins_.back().joint].node == origin.node;
        if (!same) skins_.push_back(make_skin(origin));
        skin_of_.push_back(static_cast<int>(skins_.size()) - 1);
    }
}

/// Vertices at one place are one if the clip keeps them together: at rest and at some times.
void SkinClip::weld_alike() {
    std::vector<std::vector<Vec3>> shapes = {shape({})};
    for (int k = 0; k < times_compared; ++k) shapes.push_back(at(length_ * k / (times_compared - 1)));
    const double apart = moved_alike * diagonal(shapes[0]);
    weld(imported_, [&](int vertex, int first) {
        return std::ranges::all_of(shapes, [&](const std::vector<Vec3>& x) { return (x[vertex] - x[first]).norm() <= apart; });
    });
}

void SkinClip::add_joints(const aiNode& node, int parent) {
    Joint joint{.node = &node, .parent = parent, .channel = nullptr};
    for (unsigned k = 0; k < clip_->mNumChannels; ++k) {
        if (clip_->mChannels[k]->mNodeName == node.mName) joint.channel = clip_->mChannels[k];
    }
    const int number = static_cast<int>(joints_.size());
    joints_.push_back(joint);
    for (unsigned k = 0; k < node.mNumChildren; ++k) add_joints(*node.mChildren[k], number);
}

int SkinClip::joint_of(const std::string& node) const {
    const auto found = std::ranges::find_if(joints_, [&](const Joint& joint) { return node == joint.node->mName.C_Str(); });
    if (found == joints_.end()) throw SceneError(file_, "bone '" + node + "' is no node");
    return static_cast<int>(found - joints_.begin());
}

const aiMeshMorphAnim* SkinClip::morph_of(const std::string& node, const std::string& mesh) const {
    for (unsigned k = 0; k < clip_->mNumMorphMeshChannels; ++k) {
        const std::string name = clip_->mMorphMeshChannels[k]->mName.C_Str();
        const std::string target = name.substr(0, name.find('*'));  // FBX: name*number
        if (target == node || target == mesh) return clip_->mMorphMeshChannels[k];
    }
    return nullptr;
}

void SkinClip::add_bone(Skin& skin, const aiMesh& mesh, unsigned bone) const {
    const aiBone& one = *mesh.mBones[bone];
    skin.bones.emplace_back(joint_of(one.mName.C_Str()), matrix(one.mOffsetMatrix));
    for (unsigned k = 0; k < one.mNumWeights; ++k) {
        const aiVertexWeight& weight = one.mWeights[k];
        if (weight.mVertexId >= mesh.mNumVertices)
            throw SceneError(file_, "bone '" + std::string(one.mName.C_Str()) + "': vertex " + std::to_string(weight.mVertexId) +
                                        " is out of range 0 ... " + std::to_string(static_cast<long>(mesh.mNumVertices) - 1));
        if (weight.mWeight > 0.0f) skin.weights[weight.mVertexId].emplace_back(static_cast<int>(bone), weight.mWeight);
    }
}

SkinClip::Skin SkinClip::make_skin(const VertexOrigin& origin) const {
    const auto own = std::ranges::find_if(joints_, [&](const Joint& joint) { return joint.node == origin.node; });
    Skin skin{
        .mesh = origin.mesh, .joint = static_cast<int>(own - joints_.begin()), .bones = {}, .weights = {}, .morph = nullptr};
    skin.weights.resize(origin.mesh->mNumVertices);
    for (unsigned k = 0; k < origin.mesh->mNumBones; ++k) add_bone(skin, *origin.mesh, k);
    skin.morph = morph_of(origin.node->mName.C_Str(), origin.mesh->mName.C_Str());
    for (std::vector<std::pair<int, double>>& shares : skin.weights) {
        double sum = 0.0;
        for (const auto& share : shares) sum += share.second;
        for (auto& share : shares) share.second /= sum;
    }
    return skin;
}

std::vector<Eigen::Matrix4d> SkinClip::joint_transforms(std::optional<double> tick) const {
    std::vector<Eigen::Matrix4d> transforms;
    for (const Joint& joint : joints_) {
        const bool moves = tick && joint.channel != nullptr;
        const Eigen::Matrix4d own = moves ? node_transform(*joint.channel, *tick) : matrix(joint.node->mTransformation);
        transforms.push_back(joint.parent < 0 ? own : transforms[joint.parent] * own);
    }
    return transforms;
}

std::vector<Vec3> SkinClip::shape(std::optional<double> tick) const {
    const std::vector<Eigen::Matrix4d> joints = joint_transforms(tick);
    std::vector<std::vector<Eigen::Matrix4d>> bones(skins_.size());
    std::vector<std::vector<std::pair<unsigned, double>>> morphs;
    for (std::size_t s = 0; s < skins_.size(); ++s) {
        for (const auto& [joint, offset] : skins_[s].bones) bones[s].push_back(joints[joint] * offset);
        const bool moves = tick && skins_[s].morph != nullptr;
        morphs.push_back(moves ? morph_weights(*skins_[s].morph, *tick) : own_morph_weights(*skins_[s].mesh));
        std::erase_if(morphs.back(), [&](const auto& m) { return m.second == 0.0 || m.first >= skins_[s].mesh->mNumAnimMeshes; });
    }
    std::vector<Vec3> vertices;
    for (std::size_t i = 0; i < imported_.origins.size(); ++i) {
        const int s = skin_of_[i];
        const unsigned vertex = imported_.origins[i].vertex;
        const Eigen::Vector4d x = morphed(*skins_[s].mesh, vertex, morphs[s]);
        Eigen::Vector4d carried = Eigen::Vector4d::Zero();
        for (const auto& [bone, share] : skins_[s].weights[vertex]) carried += share * (bones[s][bone] * x);
        if (skins_[s].weights[vertex].empty()) carried = joints[skins_[s].joint] * x;
        vertices.push_back(unit_ * carried.head<3>());
        check_finite(vertices.back(), i, file_);
    }
    return vertices;
}

std::vector<Vec3> SkinClip::at(double time) { return shape(std::clamp(time, 0.0, length_) * ticks_per_s_); }

std::string SkinClip::text() const { return "clip '" + name_ + "' of " + short_number(length_) + " s"; }

}  // namespace percale::scenes
