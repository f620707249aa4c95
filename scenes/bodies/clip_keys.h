#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

struct aiMesh;
struct aiMeshMorphAnim;
struct aiNodeAnim;

namespace percale::scenes {

/// A node's transform to its parent at a tick: translation T, rotation R, scale S of its keys, x -> T + R S x. Linear between
/// keys, rotations the shortest way at a constant rate; constant outside.
Eigen::Matrix4d node_transform(const aiNodeAnim& channel, double tick);

/// How much of each morph target of a mesh a vertex takes at a tick, linear between keys: target and weight.
std::vector<std::pair<unsigned, double>> morph_weights(const aiMeshMorphAnim& channel, double tick);

/// Those that the mesh has without an animation.
std::vector<std::pair<unsigned, double>> own_morph_weights(const aiMesh& mesh);

/// The time of the last key of a node or of morph weights, in ticks.
double last_key(const aiNodeAnim& channel);
double last_key(const aiMeshMorphAnim& channel);

}  // namespace percale::scenes
