#pragma once

#include <array>
#include <string>
#include <vector>

#include "bodies/shape_source.h"
#include "format/scene.h"

namespace percale::scenes {

/// A name of files with %d or %04d in it: the number that a frame of an animation has there, padded with zeros to so many digits.
struct FramePattern {
    std::string before, after;
    int digits = 0;

    std::string name_of(int frame) const;
};

/// Throws SceneError unless the name holds exactly one %d or %0Nd.
FramePattern frame_pattern(const std::string& name);

/// An obstacle with a mesh file for each frame. All files have the same triangles, and each is read when it is first needed.
class MeshSequence : public SampledShapes {
public:
    /// Reads the first frame. Throws SceneError if any of the files is missing, and what import_mesh throws for the first one.
    MeshSequence(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>* warnings = nullptr);

    const TriangleMesh& mesh() const override { return first_; }

private:
    /// Throws SceneError for a file that cannot be read, or has other triangles than the first.
    std::vector<Vec3> load(int sample) const override;
    std::string file_of(int sample) const { return pattern_.name_of(first_frame_ + sample); }

    FramePattern pattern_;
    int first_frame_;
    double unit_;
    std::string part_;
    TriangleMesh first_;
};

/// Throws SceneError, naming both files, unless the triangles are the same.
void check_same_triangles(const TriangleMesh& mesh, const std::string& file, const TriangleMesh& first,
                          const std::string& first_file);

/// Throws SceneError for a mesh in a format whose vertices are joined by position, since that may differ from file to file.
void check_keeps_vertices(const std::string& mesh, const std::string& what);

}  // namespace percale::scenes
