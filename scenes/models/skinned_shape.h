#pragma once

#include <functional>
#include <span>
#include <vector>

#include "models/model.h"

namespace percale::scenes {

/// Where a vertex comes from: number `vertex` of the mesh that is part `part` of a node.
struct VertexOrigin {
    int node = 0, part = 0, vertex = 0;
};

/// From each node's axes to those of the model; `own`: to its parent's.
std::vector<Eigen::Matrix4d> node_poses(const Model& model, const std::function<Eigen::Matrix4d(int node)>& own);
/// As they stand in the file.
std::vector<Eigen::Matrix4d> rest_poses(const Model& model);

/// Weights of morph targets of a mesh on a node, one for each of the first of them; of the others 0.
using MorphWeights = std::function<std::vector<double>(int node, const ModelMesh& mesh)>;
/// Those of the file: the node's, or else the mesh's. The model must outlive them.
MorphWeights rest_weights(const Model& model);

/// Places of vertices: morph targets mixed in, x + sum of w (target - x), then carried by the joints of the part's skin, the mean
/// of P_j B_j x by shares (P: a joint's pose, B: its offset; linear blend skinning), whatever its own node does; a vertex without
/// a share, and a part without a skin, by the node. Both must outlive it.
class SkinnedShape {
public:
    SkinnedShape(const Model& model, std::span<const VertexOrigin> origins);

    /// In the order of the origins, in units of the file.
    std::vector<Vec3> at(const std::vector<Eigen::Matrix4d>& poses, const MorphWeights& weights) const;

private:
    struct Carried {
        int joint = 0;
        double share = 0.0;  // of all shares of the vertex: together 1
    };
    /// Origins that follow each other, of one part.
    struct Group {
        int node = 0;
        const ModelMesh* mesh = nullptr;
        const ModelSkin* skin = nullptr;
        std::size_t first = 0, end = 0;            // of the origins
        std::vector<std::vector<Carried>> shares;  // of each vertex of the mesh
    };
    Group make_group(const VertexOrigin& origin, std::size_t first) const;

    const Model& model_;
    std::span<const VertexOrigin> origins_;
    std::vector<Group> groups_;
};

}  // namespace percale::scenes
