#include "bodies/clip_keys.h"

#include <assimp/anim.h>
#include <assimp/mesh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <span>

namespace percale::scenes {
namespace {

/// The keys before and after a tick, and the share of the second.
template <class Key>
struct Between {
    const Key &before, &after;
    double share;
};

/// Of at least one key.
template <class Key>
Between<Key> keys_at(std::span<const Key> keys, double tick) {
    const auto later = std::upper_bound(keys.begin(), keys.end(), tick, [](double t, const Key& key) { return t < key.mTime; });
    if (later == keys.begin()) return {keys.front(), keys.front(), 0.0};
    if (later == keys.end()) return {keys.back(), keys.back(), 0.0};
    const Key& before = *std::prev(later);
    return {before, *later, (tick - before.mTime) / (later->mTime - before.mTime)};
}

Eigen::Vector3d vector_at(std::span<const aiVectorKey> keys, double tick, const Eigen::Vector3d& without) {
    if (keys.empty()) return without;
    const auto [before, after, share] = keys_at(keys, tick);
    const Eigen::Vector3d a(before.mValue.x, before.mValue.y, before.mValue.z), b(after.mValue.x, after.mValue.y, after.mValue.z);
    return a + share * (b - a);
}

Eigen::Quaterniond rotation_at(std::span<const aiQuatKey> keys, double tick) {
    if (keys.empty()) return Eigen::Quaterniond::Identity();
    const auto [before, after, share] = keys_at(keys, tick);
    const auto rotation = [](const aiQuaternion& q) { return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized(); };
    return rotation(before.mValue).slerp(share, rotation(after.mValue));
}

void add_weights(const aiMeshMorphKey& key, double share, std::vector<std::pair<unsigned, double>>& weights) {
    for (unsigned k = 0; k < key.mNumValuesAndWeights; ++k) weights.emplace_back(key.mValues[k], share * key.mWeights[k]);
}

}  // namespace

Eigen::Matrix4d node_transform(const aiNodeAnim& channel, double tick) {
    const Eigen::Vector3d translation =
        vector_at({channel.mPositionKeys, channel.mNumPositionKeys}, tick, Eigen::Vector3d::Zero());
    const Eigen::Vector3d scale = vector_at({channel.mScalingKeys, channel.mNumScalingKeys}, tick, Eigen::Vector3d::Ones());
    const Eigen::Quaterniond rotation = rotation_at({channel.mRotationKeys, channel.mNumRotationKeys}, tick);
    return (Eigen::Translation3d(translation) * rotation * Eigen::Scaling(scale)).matrix();
}

std::vector<std::pair<unsigned, double>> morph_weights(const aiMeshMorphAnim& channel, double tick) {
    std::vector<std::pair<unsigned, double>> weights;
    if (channel.mNumKeys == 0) return weights;
    const auto [before, after, share] = keys_at(std::span<const aiMeshMorphKey>(channel.mKeys, channel.mNumKeys), tick);
    add_weights(before, 1.0 - share, weights);
    add_weights(after, share, weights);
    return weights;
}

std::vector<std::pair<unsigned, double>> own_morph_weights(const aiMesh& mesh) {
    std::vector<std::pair<unsigned, double>> weights;
    for (unsigned k = 0; k < mesh.mNumAnimMeshes; ++k) weights.emplace_back(k, mesh.mAnimMeshes[k]->mWeight);
    return weights;
}

double last_key(const aiNodeAnim& channel) {
    double last = 0.0;
    if (channel.mNumPositionKeys > 0) last = std::max(last, channel.mPositionKeys[channel.mNumPositionKeys - 1].mTime);
    if (channel.mNumRotationKeys > 0) last = std::max(last, channel.mRotationKeys[channel.mNumRotationKeys - 1].mTime);
    if (channel.mNumScalingKeys > 0) last = std::max(last, channel.mScalingKeys[channel.mNumScalingKeys - 1].mTime);
    return last;
}

double last_key(const aiMeshMorphAnim& channel) { return channel.mNumKeys > 0 ? channel.mKeys[channel.mNumKeys - 1].mTime : 0.0; }

}  // namespace percale::scenes
