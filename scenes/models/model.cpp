#include "models/model.h"

#include <algorithm>
#include <limits>

#include "percale/error.h"

namespace percale::scenes {

namespace {

template <class Archive, class Matrix>
void exchange_matrix(Archive& archive, Matrix& matrix) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) archive(matrix(row, column));
}

/// Throws SceneError unless 0 <= number < count.
void check_number(int number, std::size_t count, const char* what, const std::string& file) {
    if (number >= 0 && static_cast<std::size_t>(number) < count) return;
    throw SceneError(file, std::string(what) + " " + std::to_string(number) + " is out of range 0 ... " +
                               std::to_string(static_cast<long>(count) - 1));
}

void check_track(std::size_t times, std::size_t values, Interpolation interpolation, const std::string& file) {
    const std::size_t wanted = (interpolation == Interpolation::cubic ? 3 : 1) * times;
    if (values != wanted)
        throw SceneError(file, "an animation has " + std::to_string(values) + " values for " + std::to_string(times) + " times");
}

void check_mesh(const ModelMesh& mesh, const std::string& file) {
    std::size_t corners = 0;
    for (const int size : mesh.face_sizes) corners += static_cast<std::size_t>(std::max(0, size));
    if (corners != mesh.corners.size()) throw SceneError(file, "mesh '" + mesh.name + "': its faces are not whole");
    std::size_t at = 0;
    for (std::size_t face = 0; face < mesh.face_sizes.size(); ++face) {
        for (int k = 0; k < mesh.face_sizes[face]; ++k, ++at) {
            const int corner = mesh.corners[at];
            if (corner >= 0 && static_cast<std::size_t>(corner) < mesh.vertices.size()) continue;
            throw SceneError(file, "face " + std::to_string(face) + ": vertex index " +
                                       std::to_string(static_cast<unsigned>(corner)) + " is out of range 0 ... " +
                                       std::to_string(static_cast<long>(mesh.vertices.size()) - 1));
        }
    }
    for (const BoneShare& share : mesh.shares) check_number(share.vertex, mesh.vertices.size(), "a bone: vertex", file);
    for (const MorphTarget& target : mesh.targets)
        if (!target.vertices.empty() && target.vertices.size() != mesh.vertices.size())
            throw SceneError(file, "mesh '" + mesh.name + "': a morph target has " + std::to_string(target.vertices.size()) +
                                       " vertices, the mesh " + std::to_string(mesh.vertices.size()));
}

void check_part(const Model& model, const ModelPart& part, const std::string& file) {
    check_number(part.mesh, model.meshes.size(), "mesh", file);
    if (part.skin == -1) return;
    check_number(part.skin, model.skins.size(), "skin", file);
    const std::size_t joints = model.skins[static_cast<std::size_t>(part.skin)].joints.size();
    for (const BoneShare& share : model.meshes[static_cast<std::size_t>(part.mesh)].shares)
        check_number(share.joint, joints, "a vertex: joint", file);
}

void check_clip(const ModelClip& clip, std::size_t nodes, const std::string& file) {
    for (const ModelChannel& channel : clip.channels) {
        check_number(channel.node, nodes, "an animation: node", file);
        for (const ModelTrack* track : {&channel.translation, &channel.rotation, &channel.scale})
            check_track(track->times.size(), track->values.size(), track->interpolation, file);
    }
    for (const ModelMorphs& morphs : clip.morphs) {
        for (const int node : morphs.nodes) check_number(node, nodes, "an animation: node", file);
        check_track(morphs.times.size(), morphs.weights.size(), morphs.interpolation, file);
    }
}

}  // namespace

template <class Archive, OfType<BoneShare> Value>
void exchange(Archive& archive, Value& share) {
    archive(share.vertex, share.joint, share.share);
}

template <class Archive, OfType<MorphTarget> Value>
void exchange(Archive& archive, Value& target) {
    archive(target.vertices, target.weight);
}

template <class Archive, OfType<ModelMesh> Value>
void exchange(Archive& archive, Value& mesh) {
    archive(mesh.name, mesh.vertices, mesh.corners, mesh.face_sizes, mesh.shares, mesh.targets);
}

template <class Archive, OfType<ModelSkin> Value>
void exchange(Archive& archive, Value& skin) {
    archive(skin.joints);
    if constexpr (Archive::reads) skin.offsets.resize(skin.joints.size());
    for (auto& offset : skin.offsets) exchange_matrix(archive, offset);
}

template <class Archive, OfType<ModelPart> Value>
void exchange(Archive& archive, Value& part) {
    archive(part.mesh, part.skin);
}

template <class Archive, OfType<ModelNode> Value>
void exchange(Archive& archive, Value& node) {
    archive(node.name, node.parent, node.parts, node.weights);
    exchange_matrix(archive, node.transform);
}

template <class Archive, OfType<ModelTrack> Value>
void exchange(Archive& archive, Value& track) {
    archive.choice(track.interpolation, 3);
    archive(track.times, track.values);
}

template <class Archive, OfType<ModelChannel> Value>
void exchange(Archive& archive, Value& channel) {
    archive(channel.node, channel.translation, channel.rotation, channel.scale);
}

template <class Archive, OfType<ModelMorphs> Value>
void exchange(Archive& archive, Value& morphs) {
    archive.choice(morphs.interpolation, 3);
    archive(morphs.nodes, morphs.times, morphs.weights);
}

template <class Archive, OfType<ModelClip> Value>
void exchange(Archive& archive, Value& clip) {
    archive(clip.name, clip.ticks_per_s, clip.channels, clip.morphs);
}

template <class Archive, OfType<Model> Value>
void exchange(Archive& archive, Value& model) {
    archive(model.nodes, model.meshes, model.skins, model.clips);
}

void check_model(const Model& model, const std::string& file) {
    for (const ModelMesh& mesh : model.meshes) check_mesh(mesh, file);
    for (const ModelSkin& skin : model.skins) {
        if (skin.offsets.size() != skin.joints.size()) throw SceneError(file, "a skin has not one matrix for each joint");
        for (const int joint : skin.joints) check_number(joint, model.nodes.size(), "a skin: node", file);
    }
    for (std::size_t k = 0; k < model.nodes.size(); ++k) {
        if (model.nodes[k].parent != -1) check_number(model.nodes[k].parent, k, "a node: parent", file);
        for (const ModelPart& part : model.nodes[k].parts) check_part(model, part, file);
    }
    for (const ModelClip& clip : model.clips) check_clip(clip, model.nodes.size(), file);
}

std::vector<std::string> clip_names(const Model& model) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < model.clips.size(); ++k)
        names.push_back(model.clips[k].name.empty() ? std::to_string(k) : model.clips[k].name);
    return names;
}

std::vector<std::byte> bytes_of(const Model& model) {
    StateWriter writer;
    writer(model);
    return writer.take();
}

Model model_of(std::span<const std::byte> bytes) {
    StateReader reader(bytes);
    Model model;
    reader(model);
    reader.demand(reader.at_end(), "more than a model");
    return model;
}

}  // namespace percale::scenes
