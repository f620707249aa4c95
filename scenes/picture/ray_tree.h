#pragma once

#include <limits>
#include <memory>
#include <span>

#include "picture/shown.h"

namespace percale::scenes {

/// What a ray meets first.
struct RayHit {
    int shape = -1;  // -1: nothing
    int triangle = -1;
    float u = 0.0f, v = 0.0f;  // weights of the triangle's second and third corner
    double distance = std::numeric_limits<double>::infinity();
};

/// Finds what rays meet, on Embree's tree. The shapes are copied. All but the constructor may be called from several threads.
/// Rays are of single precision about the middle of the shapes.
class RayTree {
public:
    /// Throws SceneError where this build lacks Embree (pictures_missing) or memory is short.
    explicit RayTree(std::span<const ShownShape> shapes);
    ~RayTree();
    RayTree(const RayTree&) = delete;
    RayTree& operator=(const RayTree&) = delete;

    /// `direction` of unit length.
    RayHit first_hit(const Vec3& origin, const Vec3& direction) const;
    /// Whether anything is nearer than `reach`, m.
    bool blocked(const Vec3& origin, const Vec3& direction, double reach) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace percale::scenes
