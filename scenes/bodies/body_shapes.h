#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bodies/shape_source.h"
#include "format/scene.h"

namespace percale::scenes {

/// The shapes of an obstacle that bends, by the time of the scene: its first shape, the lead-in, and the shapes that are played.
class BodyShapes {
public:
    /// Opens the files of the obstacle. Throws SceneError for what cannot be read or does not fit together.
    BodyShapes(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>* warnings = nullptr);

    /// The mesh as it starts, m before the pose.
    const TriangleMesh& first() const { return first_; }
    /// The vertices at a time (s) of the scene, m before the pose. Throws SceneError for a file that cannot be read, or has other
    /// triangles.
    std::vector<Vec3> at(double time);
    /// The time from which on the obstacle keeps its shape, s; infinite for shapes that are played in a loop.
    double end() const;
    /// The time by which every shape that is played has been shown once, s.
    double once() const { return from_ + lead_in_ + source_->length() - offset_ + closing_; }
    /// The time between two shapes of the files, s.
    double frame_time() const { return source_->frame_time(); }
    /// "121 frames in 4.84 s, again and again, from 1 s on, first a lead-in of 0.5 s"
    std::string text() const;

private:
    std::vector<Vec3> played(double time);

    std::unique_ptr<ShapeSource> source_;
    double lead_in_, from_, offset_;
    bool loop_;
    double closing_ = 0.0;     // s, from the last shape to the first
    std::vector<Vec3> start_;  // the shape before lead_in; empty without one
    TriangleMesh first_;
};

/// Throws SceneError for an obstacle that does not bend but has keys of those that do, or whose mesh names frames instead of a
/// file.
void check_still(const Scene& scene, const ObstacleSpec& obstacle);

}  // namespace percale::scenes
