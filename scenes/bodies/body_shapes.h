#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bodies/shape_source.h"
#include "format/scene.h"

namespace percale::scenes {

/// The shapes of an obstacle that bends, by the time of the scene: what it is at first, how it gets to what is played, and when.
class BodyShapes {
public:
    /// Opens its files. Throws SceneError for what cannot be read or does not fit together.
    BodyShapes(const Scene& scene, const ObstacleSpec& obstacle, std::vector<std::string>* warnings = nullptr);

    /// The mesh as it starts, m before the pose.
    const TriangleMesh& first() const { return first_; }
    /// Vertices at a time of the scene, s, m before the pose. Throws SceneError for a file that cannot be read, or has other
    /// triangles.
    std::vector<Vec3> at(double time);
    /// s, from when on it keeps its shape; infinite of what is played again and again.
    double end() const;
    /// s: by then all that it plays has been there once.
    double once() const { return from_ + lead_in_ + source_->length() - offset_ + closing_; }
    /// s, between two shapes of its files.
    double frame_time() const { return source_->frame_time(); }
    /// "121 frames in 4.84 s, again and again, from 1 s on, first a lead-in of 0.5 s"
    std::string text() const;

private:
    std::vector<Vec3> played(double time);

    std::unique_ptr<ShapeSource> source_;
    double lead_in_, from_, offset_;
    bool loop_;
    double closing_ = 0.0;     // s, from the last shape to the first
    std::vector<Vec3> start_;  // before lead_in; empty without
    TriangleMesh first_;
};

/// Throws SceneError for an obstacle that does not bend with keys of those that do, or whose mesh is no file but a name of
/// frames.
void check_still(const Scene& scene, const ObstacleSpec& obstacle);

}  // namespace percale::scenes
