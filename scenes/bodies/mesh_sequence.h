#pragma once

#include <array>
#include <string>
#include <vector>

#include "format/scene.h"
#include "percale/mesh.h"

namespace percale::scenes {

/// A name of files with %d or %04d in it: the number that a frame of an animation has there, padded with zeros to so many digits.
struct FramePattern {
    std::string before, after;
    int digits = 0;

    std::string name_of(int frame) const;
};

/// Throws SceneError where there is other than one %d or %0Nd.
FramePattern frame_pattern(const std::string& name);

/// An obstacle whose mesh is another in each frame: one file a frame, all with the same triangles. Files are read when they are
/// first needed; those of two frames are kept.
class MeshSequence {
public:
    /// Reads the first frame. Throws SceneError for a file that is missing, any of them, and what import_mesh throws for the
    /// first.
    MeshSequence(const Scene& scene, const ObstacleSpec& obstacle, std::vector<std::string>* warnings = nullptr);

    const TriangleMesh& first() const { return first_; }
    /// Vertices at a time, s, in m before the pose: linear between frames, constant before the first and after the last. Throws
    /// SceneError for a file that cannot be read, or has other triangles than the first.
    std::vector<Vec3> at(double time);

private:
    struct Loaded {
        int frame = -1;
        std::vector<Vec3> vertices;
    };

    std::string file_of(int frame) const;
    /// The frame that comes second on the way to `other` takes the place of what is not needed.
    const std::vector<Vec3>& frame(int number, int other);

    FramePattern pattern_;
    std::array<int, 2> frames_;
    double fps_, unit_;
    std::string part_;
    TriangleMesh first_;
    std::array<Loaded, 2> loaded_;
};

/// Throws SceneError for an obstacle without frames whose mesh is no file but a name of frames, or that has frames a second.
void check_still(const Scene& scene, const ObstacleSpec& obstacle);

}  // namespace percale::scenes
