#pragma once

#include <vector>

#include "picture/camera.h"
#include "picture/surfaces.h"

namespace percale::scenes {

/// How much of the lights reaches a point.
struct LightShare {
    float sky = 1.0f, key = 1.0f;  // 0 ... 1: of the sky's light, weighted by its cosine; of the lamp's face
};

/// A lamp of some width, up and to the left behind the viewer, and a sky that is lighter above. Directions are fixed, so that the
/// same picture always has the same bytes.
class Lights {
public:
    /// A point is measured by one of this many parts of all directions; points side by side that take different ones, together,
    /// all.
    static constexpr int parts = 16;
    static constexpr int all_parts = -1;

    /// `sky_reach`: m, what is farther hides no sky.
    Lights(const Camera& camera, double sky_reach);

    /// Measures the light at a point by one part of the directions, 0 ... parts - 1, or by all_parts.
    LightShare measure(const Surfaces& surfaces, const SurfacePoint& point, int part) const;
    /// The light that a surface of a colour sends to the viewer, who is in direction `to_eye`.
    Colour shade(const Colour& colour, const SurfacePoint& point, const Eigen::Vector3f& to_eye, const LightShare& share) const;
    /// How much darker the ground is than without shadows, 0 ... 1.
    float ground_shadow(const LightShare& share) const;

private:
    Eigen::Vector3f lamp_;
    double sky_reach_;
    std::vector<Vec3> lamp_directions_, sky_directions_;  // those of the sky about +z
};

}  // namespace percale::scenes
