#include "obstacle_impulse.h"

#include <Eigen/Geometry>

#include "contact/contact_loads.h"
#include "solve/implicit_stage.h"

namespace percale {

void ObstacleImpulse::take(const Vec3& at, const Vec3& given) {
    linear -= given;
    angular -= at.cross(given);
}

void add_contact_impulses(const StagePoint& stage, double time, std::vector<ObstacleImpulse>& impulses) {
    if (impulses.empty()) return;
    for_each_push(stage.constraints, stage.contact, stage.constraint_forces, [&](const Push& push) {
        impulses[push.obstacle].take(stage.positions.at(push.vertex), time * (push.normal + push.friction));
    });
}

}  // namespace percale
