#pragma once

#include <vector>

#include "percale/mesh.h"

namespace percale {

struct StagePoint;

/// The impulse of cloth on an obstacle since the step began. Constraints between cloths give none.
struct ObstacleImpulse {
    Vec3 linear = Vec3::Zero();   // N s
    Vec3 angular = Vec3::Zero();  // N m s, about the origin of the world

    /// `given`: N s, received by cloth at a point (m).
    void take(const Vec3& at, const Vec3& given);
};

/// Adds the impulses of a stage's contacts, its forces times `time` (s), at its end. One entry an obstacle; empty: not
/// requested.
void add_contact_impulses(const StagePoint& stage, double time, std::vector<ObstacleImpulse>& impulses);

}  // namespace percale
