#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "bodies/shape_source.h"
#include "format/scene.h"

namespace percale::scenes {

/// The vertices of a mesh at many times, from a file of 3ds Max (PC2) or LightWave (MDD), which animation programs write. A
/// sample is read when it is first needed.
///   PC2, little endian: "POINTCACHE2", 0, int32 1, int32 points, float32 start, float32 frames a sample, int32 samples; then
///   x, y, z of every point of every sample, float32. Sample k is that of the time k frames_a_sample / fps; the start is left
///   out. MDD, big endian: int32 samples, int32 points, float32 time of each sample, s, taken from the first; then as above.
class PointCache : public SampledShapes {
public:
    /// Reads the mesh and the header of obstacle.cache. Throws SceneError where they do not fit, or the file is shorter than its
    /// header claims.
    PointCache(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>* warnings = nullptr);

    const TriangleMesh& mesh() const override { return mesh_; }

private:
    /// Throws SceneError for what cannot be read and for a coordinate that is not finite.
    std::vector<Vec3> load(int sample) const override;
    void read_pc2(std::istream& in, double fps);
    void read_mdd(std::istream& in);
    void check_counts(std::int64_t points, std::int64_t samples) const;

    std::string file_;
    TriangleMesh mesh_;
    double unit_;
    bool big_endian_ = false;
    std::int64_t header_ = 0;  // bytes
};

}  // namespace percale::scenes
