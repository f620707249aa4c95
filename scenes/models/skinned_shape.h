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

/// The transforms from each node's axes to those of the model; `own`: to those of its parent.
std::vector<Eigen::Matrix4d> node_poses(const Model& model, const std::function<Eigen::Matrix4d(int node)>& own);
/// The same for the transforms of the file.
std::vector<Eigen::Matrix4d> rest_poses(const Model& model);

/// Weights of morph targets of a mesh on a node, one for each of the first of them; of the others 0.
using MorphWeights = std::function<std::vector<double>(int node, const ModelMesh& mesh)>;
/// Those of the file: the node's, or else the mesh's. The model must outlive them.
MorphWeights rest_weights(const Model& model);

/// Positions of vertices: morph targets are mixed in, x + sum of w (target - x), then the joints of the part's skin carry them,
/// the mean of P_j B_j x weighted by shares (P: a joint's pose, B: its offset; linear blend skinning), whatever its own node
/// does; the node carries a vertex without a share and a part without a skin. Both must outlive it.
class SkinnedShape {
public:
    SkinnedShape(const Model& model, std::span<const VertexOrigin> origins);

    /// The positions, in the order of the origins, in units of the file.
    std::vector<Vec3> at(const std::vector<Eigen::Matrix4d>& poses, const MorphWeights& weights) const;

private:
    struct Carried {
        int joint = 0;
        double share = 0.0;  // the shares of a vertex sum to 1
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
