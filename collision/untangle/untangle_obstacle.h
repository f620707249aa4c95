#pragma once

#include <optional>
#include <vector>

#include "certificate/box_tree.h"
#include "percale/mesh.h"

namespace percale {

/// An obstacle for the queries of untangling, in world coordinates.
class SolidObstacle {
public:
    explicit SolidObstacle(TriangleMesh mesh);

    const std::vector<Vec3>& vertices() const { return mesh_.vertices; }
    const std::vector<certificate::Corners>& triangles() const { return triangles_; }
    const certificate::BoxTree& tree() const { return tree_; }
    bool watertight() const { return watertight_; }

    /// Whether a point is inside; false for an open obstacle. Exact.
    bool inside(const Vec3& point) const;

    /// How far a point is from leaving along the unit vector `direction`, m: of a watertight obstacle the first place on its
    /// surface beyond which is outside; of an open one, the first place on it. Nothing where there is no such place.
    std::optional<double> exit(const Vec3& point, const Vec3& direction) const;

    /// The point at distance `clearance` (m, > 0) from the surface, on the outer side of the place nearest to `point`; the point
    /// itself where it is outside and at least that far away. For watertight obstacles.
    Vec3 pushed_out(const Vec3& point, double clearance) const;

private:
    TriangleMesh mesh_;
    std::vector<certificate::Corners> triangles_;
    certificate::BoxTree tree_;
    bool watertight_;
};

}  // namespace percale
