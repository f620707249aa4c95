#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bodies/shape_source.h"
#include "format/scene.h"
#include "meshes/scene_import.h"

struct aiAnimation;
struct aiMeshMorphAnim;
struct aiNodeAnim;

namespace percale::scenes {

/// An animation of a glTF, GLB, FBX or DAE file: nodes move, bones carry vertices (linear blend skinning: the mean of where its
/// bones take a vertex, by weights), and morph targets are mixed. Vertices at one place become one where the clip keeps them
/// together.
class SkinClip : public ShapeSource {
public:
    /// Reads all of obstacle.mesh. Throws SceneError for a file without that clip, or one that does not fit together.
    SkinClip(const Scene& scene, const ObstacleSpec& obstacle);

    /// In its rest pose.
    const TriangleMesh& mesh() const override { return mesh_; }
    double length() const override { return length_; }
    double frame_time() const override { return 1.0 / ObstacleSpec::usual_fps; }
    std::vector<Vec3> at(double time) override;
    std::string text() const override;

private:
    struct Joint {
        const aiNode* node;
        int parent;                 // its number; -1 of the root
        const aiNodeAnim* channel;  // null: it keeps its transform
    };
    /// A mesh on a node.
    struct Skin {
        const aiMesh* mesh;
        int joint;
        std::vector<std::pair<int, Eigen::Matrix4d>> bones;        // joint, and from the mesh to it at rest
        std::vector<std::vector<std::pair<int, double>>> weights;  // of each vertex: bone and share
        const aiMeshMorphAnim* morph;                              // null: its targets keep their weights
    };

    void add_joints(const aiNode& node, int parent);
    void add_skins();
    void weld_alike();
    int joint_of(const std::string& node) const;
    Skin make_skin(const VertexOrigin& origin) const;
    void add_bone(Skin& skin, const aiMesh& mesh, unsigned bone) const;
    const aiMeshMorphAnim* morph_of(const std::string& node, const std::string& mesh) const;
    /// Without a tick at rest.
    std::vector<Vec3> shape(std::optional<double> tick) const;
    std::vector<Eigen::Matrix4d> joint_transforms(std::optional<double> tick) const;

    std::string file_;
    double unit_, ticks_per_s_ = 0.0, length_ = 0.0;
    ImportedScene imported_;
    const aiAnimation* clip_ = nullptr;
    std::string name_;
    std::vector<Joint> joints_;  // parents first
    std::vector<Skin> skins_;
    std::vector<int> skin_of_;  // of each vertex
    TriangleMesh mesh_;
};

}  // namespace percale::scenes
