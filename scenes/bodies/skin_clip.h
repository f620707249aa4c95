#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bodies/shape_source.h"
#include "format/scene.h"
#include "models/joined_model.h"

namespace percale::scenes {

/// An animation of a glTF, GLB, FBX or DAE file: nodes move, bones carry vertices (SkinnedShape), and morph targets are mixed.
/// Vertices at one place become one where the clip keeps them together.
class SkinClip : public ShapeSource {
public:
    /// Reads all of obstacle.mesh. Throws SceneError for a file without that clip, or one that does not fit together.
    SkinClip(const Scene& scene, const ObstacleSpec& obstacle);
    SkinClip(const SkinClip&) = delete;
    SkinClip& operator=(const SkinClip&) = delete;

    /// The mesh in its rest pose.
    const TriangleMesh& mesh() const override { return mesh_; }
    double length() const override { return length_; }
    double frame_time() const override { return 1.0 / ObstacleSpec::usual_fps; }
    std::vector<Vec3> at(double time) override;
    std::string text() const override;

private:
    void weld_alike();
    /// The vertices at a tick of the clip.
    std::vector<Vec3> shape(double tick) const;

    std::string file_;
    double unit_, length_ = 0.0;
    JoinedModel joined_;
    const ModelClip* clip_ = nullptr;
    std::vector<const ModelChannel*> channels_;  // of each node; null: it keeps its transform
    std::vector<const ModelMorphs*> morphs_;     // of each node; null: its targets keep their weights
    std::string name_;
    TriangleMesh mesh_;
    std::optional<SkinnedShape> skinned_;  // of the model and the origins
};

}  // namespace percale::scenes
