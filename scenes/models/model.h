#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "percale/mesh.h"
#include "percale/saved_state.h"

// What files of models hold, whatever their format: nodes in a tree, meshes on them, skins, morph targets and animations. Plain
// values, in units of the file.
namespace percale::scenes {

/// How much of a vertex a joint of its skin carries.
struct BoneShare {
    int vertex = 0, joint = 0;
    double share = 0.0;
};

/// The position of each vertex where the target has weight 1; empty: it moves none.
struct MorphTarget {
    std::vector<Vec3> vertices;
    double weight = 0.0;  // without an animation
};

struct ModelMesh {
    std::string name;
    std::vector<Vec3> vertices;
    std::vector<int> corners, face_sizes;  // polygons, one after the other
    std::vector<BoneShare> shares;
    std::vector<MorphTarget> targets;
};

/// Nodes that carry vertices, and where each had a mesh's vertices at rest.
struct ModelSkin {
    std::vector<int> joints;
    std::vector<Eigen::Matrix4d> offsets;  // from the mesh to the joint (inverse bind matrix)
};

/// A mesh that hangs on a node.
struct ModelPart {
    int mesh = 0, skin = -1;  // -1: it goes along with the node
};

struct ModelNode {
    std::string name;
    int parent = -1;                                          // its number, below the own one; -1: a root
    Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();  // to the parent
    std::vector<ModelPart> parts;
    std::vector<double> weights = {};  // of its meshes' morph targets without an animation; empty: as the meshes have them
};

enum class Interpolation { linear, step, cubic };

/// Values at ascending times; of `cubic` three for each: the tangent before, the value, the tangent behind.
struct ModelTrack {
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times;                  // ticks
    std::vector<std::array<double, 4>> values;  // x, y, z and 0, or a quaternion x, y, z, w
};

/// How a node moves; a track without times: as its file has it.
struct ModelChannel {
    int node = 0;
    ModelTrack translation, rotation, scale;
};

/// Weights of morph targets of the meshes on some nodes: at each time one for each target, of `cubic` three lists.
struct ModelMorphs {
    std::vector<int> nodes;
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times;  // ticks
    std::vector<std::vector<double>> weights;
};

struct ModelClip {
    std::string name;
    double ticks_per_s = 1.0;
    std::vector<ModelChannel> channels;
    std::vector<ModelMorphs> morphs;
};

struct Model {
    std::vector<ModelNode> nodes;
    std::vector<ModelMesh> meshes;
    std::vector<ModelSkin> skins;
    std::vector<ModelClip> clips;
};

/// Throws SceneError naming the file where a number leads to nothing: of a corner, mesh, skin, joint, node or vertex, or where
/// lists that belong together differ in length.
void check_model(const Model& model, const std::string& file);

/// Names of its animations; of one without a name its number, from 0.
std::vector<std::string> clip_names(const Model& model);

/// Every bit of a model, for StateWriter and StateReader.
std::vector<std::byte> bytes_of(const Model& model);
Model model_of(std::span<const std::byte> bytes);

}  // namespace percale::scenes
