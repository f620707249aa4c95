#include "bodies/skin_clip.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "bodies/clip_keys.h"
#include "common/nearest_name.h"
#include "common/text.h"
#include "garment/cloth_shape.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// Fraction of the body's diagonal. Vertices at one place that a clip moves apart by more are two. 0: rounding tears seams of
/// texture.
constexpr double moved_alike = 1e-6;

/// Times at which they are compared. Fewer: some part between them.
constexpr int times_compared = 9;

void check_can_be_animated(const std::string& file) {
    const std::vector<std::string> animated = {".gltf", ".glb", ".fbx", ".dae"};
    if (std::ranges::find(animated, extension_of(file)) == animated.end())
        throw SceneError(file, "has no clips, which are read from " + joined(animated));
    if (!std::filesystem::is_regular_file(file)) throw SceneError(file, "no such file");
}

/// Finds a clip by its name, or else by its number.
const ModelClip& clip_named(const Model& model, const std::string& clip, const std::string& file) {
    const std::vector<std::string> names = clip_names(model);
    if (names.empty()) throw SceneError(file, "has no animations, so no clip '" + clip + "'");
    const auto found = std::ranges::find(names, clip);
    if (found != names.end()) return model.clips[static_cast<std::size_t>(found - names.begin())];
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(clip.data(), clip.data() + clip.size(), number);
    if (error != std::errc() || end != clip.data() + clip.size() || number >= names.size())
        throw SceneError(file, "has no clip '" + clip + "'" + suggestion(clip, names));
    return model.clips[number];
}

}  // namespace

SkinClip::SkinClip(const Scene& scene, const ObstacleSpec& obstacle)
    : file_(path_beside(scene, obstacle.mesh)), unit_(obstacle.unit) {
    check_can_be_animated(file_);
    if (obstacle.fps) throw SceneError(file_, "has its own times; fps is for frames and PC2 caches");
    joined_ = read_joined_model(file_, obstacle.part);
    if (joined_.mesh.triangles.empty()) throw SceneError(file_, "no triangles");
    clip_ = &clip_named(joined_.model, *obstacle.clip, file_);
    name_ = clip_->name.empty() ? *obstacle.clip : clip_->name;
    length_ = last_key(*clip_) / clip_->ticks_per_s;
    if (!(length_ > 0.0 && std::isfinite(length_)))
        throw SceneError(file_, "clip '" + name_ + "' has no two keys: nothing moves");
    channels_.resize(joined_.model.nodes.size());
    morphs_.resize(joined_.model.nodes.size());
    for (const ModelChannel& channel : clip_->channels) channels_[static_cast<std::size_t>(channel.node)] = &channel;
    for (const ModelMorphs& morphs : clip_->morphs) {
        for (const int node : morphs.nodes) {
            const ModelMorphs*& known = morphs_[static_cast<std::size_t>(node)];
            if (known == nullptr) known = &morphs;
        }
    }
    for (std::size_t k = 0; k < joined_.mesh.vertices.size(); ++k) check_finite(joined_.mesh.vertices[k] *= unit_, k, file_);
    weld_alike();
    mesh_ = joined_.mesh;
}

/// Vertices at one place become one if the clip keeps them together at rest and at some times.
void SkinClip::weld_alike() {
    skinned_.emplace(joined_.model, joined_.origins);
    std::vector<std::vector<Vec3>> shapes = {joined_.mesh.vertices};
    for (int k = 0; k < times_compared; ++k) shapes.push_back(at(length_ * k / (times_compared - 1)));
    const double apart = moved_alike * diagonal(shapes[0]);
    weld(joined_, [&](int vertex, int first) {
        return std::ranges::all_of(shapes, [&](const std::vector<Vec3>& x) { return (x[vertex] - x[first]).norm() <= apart; });
    });
    skinned_.emplace(joined_.model, joined_.origins);
}

std::vector<Vec3> SkinClip::shape(double tick) const {
    const Model& model = joined_.model;
    const auto own = [&](int node) {
        const ModelChannel* channel = channels_[static_cast<std::size_t>(node)];
        return channel != nullptr ? node_transform(*channel, tick) : model.nodes[static_cast<std::size_t>(node)].transform;
    };
    const MorphWeights at_rest = rest_weights(model);
    const auto weights = [&](int node, const ModelMesh& mesh) {
        const ModelMorphs* morphs = morphs_[static_cast<std::size_t>(node)];
        return morphs != nullptr ? morph_weights(*morphs, tick) : at_rest(node, mesh);
    };
    std::vector<Vec3> vertices = skinned_->at(node_poses(model, own), weights);
    for (std::size_t k = 0; k < vertices.size(); ++k) check_finite(vertices[k] *= unit_, k, file_);
    return vertices;
}

std::vector<Vec3> SkinClip::at(double time) { return shape(std::clamp(time, 0.0, length_) * clip_->ticks_per_s); }

std::string SkinClip::text() const { return "clip '" + name_ + "' of " + short_number(length_) + " s"; }

}  // namespace percale::scenes
