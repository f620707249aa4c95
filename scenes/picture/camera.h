#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>

#include "percale/mesh.h"

namespace percale::scenes {

/// From where a picture is taken.
struct CameraAim {
    double azimuth = 28.0;            // degrees; 0 looks at the side that faces +z, 90 at the one that faces +x
    double elevation = 12.0;          // degrees, -90 ... 90; 90 looks down
    double zoom = 1.0;                // > 0; 2: all is twice as large, about the middle of the picture
    std::optional<Vec3> target = {};  // m, what the middle of the picture shows; none: the middle of what is fitted
};

/// The aim of a name: front, side (from +x), back, top, three_quarter. Throws SceneError for another one.
CameraAim aim_of_view(const std::string& view);

/// An orthonormal frame and a perspective. Pixels are counted from the upper left corner of the picture, to the right and down.
struct Camera {
    Vec3 eye = Vec3::Zero();                                               // m
    Vec3 right = Vec3::UnitX(), up = Vec3::UnitY(), back = Vec3::UnitZ();  // back: from what is looked at to the eye
    double focal = 2.0;                                                    // in heights of the picture
    int width = 0, height = 0;                                             // pixels
    double middle = 0.0;  // pixels from the left, where the axis meets the picture; halfway down

    /// Through a place of the picture, unit length.
    Vec3 direction(double x, double y) const;
    /// Where a point is seen, pixels, and its depth along the axis, m.
    Vec3 project(const Vec3& point) const;
    /// How large a pixel is at a depth, m.
    double pixel_size(double depth) const { return depth / (focal * height); }
};

/// Finds the nearest camera that sees all points with a margin.
class ViewFit {
public:
    /// Throws SceneError for an elevation outside -90 ... 90, a zoom that is not above 0, what is not finite.
    ViewFit(const CameraAim& aim, int width, int height);
    void add(std::span<const Vec3> points);
    /// Throws SceneError where no point was added.
    Camera camera() const;
    /// The same in a picture that goes on to the right of what the points are fitted to, `width` pixels in all.
    Camera camera_of_wider(int width) const;

private:
    /// Of the points in the camera's frame: along an axis a and the axis b to the eye, with the tangent t of half the angle that
    /// is seen, the eye at (p, d) sees them where p + t d >= highest of (a + t b) and p - t d <= lowest of (a - t b).
    struct Edges {
        double tangent = 1.0;
        double high = -std::numeric_limits<double>::infinity(), low = std::numeric_limits<double>::infinity();

        double place() const { return 0.5 * (high + low); }
        double distance() const { return 0.5 * (high - low) / tangent; }
    };

    CameraAim aim_;
    Camera frame_;
    Edges across_, upwards_;
    double nearest_ = -std::numeric_limits<double>::infinity();  // of the points, along `back`
};

}  // namespace percale::scenes
