#include "models/skinned_shape.h"

namespace percale::scenes {

namespace {

Vec3 morphed(const ModelMesh& mesh, std::size_t vertex, std::span<const double> weights) {
    const Vec3& own = mesh.vertices[vertex];
    Vec3 x = own;
    for (std::size_t k = 0; k < std::min(weights.size(), mesh.targets.size()); ++k)
        if (weights[k] != 0.0 && !mesh.targets[k].vertices.empty()) x += weights[k] * (mesh.targets[k].vertices[vertex] - own);
    return x;
}

}  // namespace

std::vector<Eigen::Matrix4d> node_poses(const Model& model, const std::function<Eigen::Matrix4d(int node)>& own) {
    std::vector<Eigen::Matrix4d> poses;
    for (std::size_t k = 0; k < model.nodes.size(); ++k) {
        const int parent = model.nodes[k].parent;
        const Eigen::Matrix4d transform = own(static_cast<int>(k));
        poses.push_back(parent < 0 ? transform : poses[static_cast<std::size_t>(parent)] * transform);
    }
    return poses;
}

std::vector<Eigen::Matrix4d> rest_poses(const Model& model) {
    return node_poses(model, [&](int node) { return model.nodes[static_cast<std::size_t>(node)].transform; });
}

MorphWeights rest_weights(const Model& model) {
    return [&model](int node, const ModelMesh& mesh) {
        std::vector<double> weights = model.nodes[static_cast<std::size_t>(node)].weights;
        if (!weights.empty()) return weights;
        for (const MorphTarget& target : mesh.targets) weights.push_back(target.weight);
        return weights;
    };
}

SkinnedShape::SkinnedShape(const Model& model, std::span<const VertexOrigin> origins) : model_(model), origins_(origins) {
    for (std::size_t k = 0; k < origins.size(); ++k) {
        const bool same = k > 0 && origins[k].node == origins[k - 1].node && origins[k].part == origins[k - 1].part;
        if (!same) groups_.push_back(make_group(origins[k], k));
        groups_.back().end = k + 1;
    }
}

SkinnedShape::Group SkinnedShape::make_group(const VertexOrigin& origin, std::size_t first) const {
    const ModelPart& part = model_.nodes[static_cast<std::size_t>(origin.node)].parts[static_cast<std::size_t>(origin.part)];
    const ModelMesh& mesh = model_.meshes[static_cast<std::size_t>(part.mesh)];
    Group group{.node = origin.node, .mesh = &mesh, .skin = nullptr, .first = first, .end = first, .shares = {}};
    group.shares.resize(mesh.vertices.size());
    if (part.skin < 0) return group;
    group.skin = &model_.skins[static_cast<std::size_t>(part.skin)];
    for (const BoneShare& share : mesh.shares)
        if (share.share > 0.0) group.shares[static_cast<std::size_t>(share.vertex)].push_back({share.joint, share.share});
    for (std::vector<Carried>& shares : group.shares) {
        double sum = 0.0;
        for (const Carried& one : shares) sum += one.share;
        for (Carried& one : shares) one.share /= sum;
    }
    return group;
}

std::vector<Vec3> SkinnedShape::at(const std::vector<Eigen::Matrix4d>& poses, const MorphWeights& weights) const {
    std::vector<Vec3> vertices;
    vertices.reserve(origins_.size());
    for (const Group& group : groups_) {
        std::vector<Eigen::Matrix4d> joints;
        if (group.skin != nullptr)
            for (std::size_t k = 0; k < group.skin->joints.size(); ++k)
                joints.push_back(poses[static_cast<std::size_t>(group.skin->joints[k])] * group.skin->offsets[k]);
        const std::vector<double> mixed = group.mesh->targets.empty() ? std::vector<double>() : weights(group.node, *group.mesh);
        for (std::size_t k = group.first; k < group.end; ++k) {
            const auto vertex = static_cast<std::size_t>(origins_[k].vertex);
            const Eigen::Vector4d x = morphed(*group.mesh, vertex, mixed).homogeneous();
            Eigen::Vector4d carried = Eigen::Vector4d::Zero();
            for (const Carried& one : group.shares[vertex])
                carried += one.share * (joints[static_cast<std::size_t>(one.joint)] * x);
            if (group.shares[vertex].empty()) carried = poses[static_cast<std::size_t>(group.node)] * x;
            vertices.emplace_back(carried.head<3>());
        }
    }
    return vertices;
}

}  // namespace percale::scenes
