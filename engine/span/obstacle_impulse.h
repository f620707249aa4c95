#pragma once

#include <vector>

#include "percale/mesh.h"

namespace percale {

struct StagePoint;

/// What cloth has given an obstacle since the step began. Rows with cloth have none.
struct ObstacleImpulse {
    Vec3 linear = Vec3::Zero();   // N s
    Vec3 angular = Vec3::Zero();  // N m s, about the origin of the world

    /// `given`: to cloth at a point (m), N s.
    void take(const Vec3& at, const Vec3& given);
};

/// Adds what the contacts of a stage give, its forces times `time` (s), at its end. One entry an obstacle; empty: nobody asks.
void add_contact_impulses(const StagePoint& stage, double time, std::vector<ObstacleImpulse>& impulses);

}  // namespace percale
