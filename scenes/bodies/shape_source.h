#pragma once

#include <array>
#include <string>
#include <vector>

#include "percale/mesh.h"

namespace percale::scenes {

/// A mesh whose vertices move with time. Lengths in m before the pose, times in s from its own start.
class ShapeSource {
public:
    virtual ~ShapeSource() = default;

    /// The triangles, and the vertices while nothing is played.
    virtual const TriangleMesh& mesh() const = 0;
    virtual double length() const = 0;
    /// The time between two of its shapes.
    virtual double frame_time() const = 0;
    /// The vertices at a time; outside 0 ... length() those of the nearer end. Throws SceneError for a file that cannot be read.
    virtual std::vector<Vec3> at(double time) = 0;
    /// "121 frames in 4.84 s"
    virtual std::string text() const = 0;
};

/// The shape at a fraction `share` of the way from one shape to another; the largest displacement of a vertex between two shapes,
/// m; and the diagonal of a shape's bounding box, m.
std::vector<Vec3> between(std::vector<Vec3> from, const std::vector<Vec3>& to, double share);
double largest_displacement(const std::vector<Vec3>& from, const std::vector<Vec3>& to);
double diagonal(const std::vector<Vec3>& shape);

/// Shapes that are sampled at some times, with linear interpolation in between. Two samples are kept.
class SampledShapes : public ShapeSource {
public:
    double length() const override { return times_.back(); }
    double frame_time() const override {
        return times_.size() > 1 ? times_.back() / static_cast<double>(times_.size() - 1) : 0.0;
    }
    std::vector<Vec3> at(double time) override;
    std::string text() const override;

protected:
    /// Times ascend from 0; at least one.
    void set_times(std::vector<double> times) { times_ = std::move(times); }
    /// `rate`: 1/s
    void set_equal_times(int count, double rate);

private:
    virtual std::vector<Vec3> load(int sample) const = 0;
    /// Loads the sample unless it is kept; it then replaces the kept one that is not `other`.
    const std::vector<Vec3>& sample(int number, int other);

    struct Loaded {
        int number = -1;
        std::vector<Vec3> vertices;
    };
    std::vector<double> times_{0.0};
    std::array<Loaded, 2> loaded_;
};

}  // namespace percale::scenes
