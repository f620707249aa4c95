#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "picture/ray_tree.h"
#include "picture/shown.h"

namespace percale::scenes {

/// Normals at the three corners of each triangle: those of the triangles around a vertex, weighted by area, that are within 60
/// degrees of this one. Smooth where the mesh is, with the edges of boxes. Zero for a triangle without area.
std::vector<std::array<Eigen::Vector3f, 3>> corner_normals(const TriangleMesh& mesh);

/// The ground below the lowest vertex, and how far it shows shadows.
struct Ground {
    double height = 0.0;  // m
    Vec3 middle = Vec3::Zero();
    double radius = 1.0;  // m, about `middle`: shadows fade out towards it
};

/// What is seen through a place of the picture.
struct SurfacePoint {
    static constexpr int nothing = -1, on_ground = -2;

    int shape = nothing;
    int triangle = -1;
    float u = 0.0f, v = 0.0f;  // weights of the second and third corner
    bool back = false;         // the side from which the triangle is clockwise
    float depth = 0.0f;        // m, from the eye
    Eigen::Vector3f place = Eigen::Vector3f::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // smooth, to the side that is seen
    Eigen::Vector3f facet = Eigen::Vector3f::Zero();   // of the triangle, likewise

    bool is_shape() const { return shape >= 0; }
};

/// Whether two points belong to one piece of surface, so that light changes little between them. `reach`: m, how far one may lie
/// from the other's plane.
bool alike(const SurfacePoint& a, const SurfacePoint& b, float reach);

/// The shapes of a frame and the ground below, for rays. The shapes must stay where they are.
class Surfaces {
public:
    Surfaces(std::span<const ShownShape> shapes, const std::optional<Ground>& ground);

    SurfacePoint look(const Vec3& eye, const Vec3& direction) const;
    /// Where rays from a point to lights start: on the surface that its normals stand for, which a flat triangle lies under, so
    /// that it does not shade itself; a little off it.
    Vec3 lifted(const SurfacePoint& point) const;
    const RayTree& tree() const { return tree_; }
    std::span<const ShownShape> shapes() const { return shapes_; }
    const std::optional<Ground>& ground() const { return ground_; }
    /// Half the diagonal of the box around all shapes, m.
    double radius() const { return radius_; }

private:
    std::span<const ShownShape> shapes_;
    std::optional<Ground> ground_;
    RayTree tree_;
    std::vector<std::vector<std::array<Eigen::Vector3f, 3>>> normals_;
    double radius_ = 1.0;
};

}  // namespace percale::scenes
