#pragma once

#include "obstacle_impulse.h"
#include "plan/scene.h"
#include "solve/implicit_stage.h"

namespace percale {

/// A stage that was just solved.
struct StageMove {
    const StagePoint& contacts;  // at its end
    const ClothState& start;     // where it began
    double length = 0.0;         // s
    double impulse_time = 0.0;   // s: contact gave its force times this
    /// In the stages of TR-BDF2 contact gives twice the impulse that stops cloth: there a pressed point leaves no faster than
    /// its mean velocity in the stage, whether it is in an impact or not.
    bool keeps_to_mean = false;
    /// m/s, the velocities from which the scheme extrapolates the change of the previous stage, contact's included; null: none.
    const Vec3Arrays* extrapolated = nullptr;
    /// Weight of the stage's changes in the substep: the second stage of TR-BDF2 continues the first one's change.
    double weight = 1.0;
};

/// A vertex whose velocity has jumped: an impact stopped it.
struct VelocityJump {
    int vertex = -1, obstacle = -1;
    Vec3 direction = Vec3::Zero();  // unit
};

/// Reusable work space of settling.
struct ImpactSpace {
    std::vector<std::size_t> order;  // of constraints
    std::vector<Impact> found;
    std::vector<VelocityJump> jumps;  // by the last settling
};

/// Changes of energy by settling, J.
struct ImpactEnergy {
    double work = 0.0;  // of obstacles on the cloth
    double loss = 0.0;  // energy lost by the cloth beyond that
};

/// Restitution (Newton's law of impact). Contact stops an approach; it does not cause a rebound, whatever its stiffness and the
/// length of the step. A point that came at a speed u, faster than gravity causes in the stage (and 2 h a second), is in an
/// impact. Once it has been stopped it leaves an obstacle with restitution e at e u, and otherwise, until u has faded, it loses
/// the part of its leaving speed that contact gave it. Constraints are treated one by one, the nearest first. Persistent
/// contacts are left alone. Changes velocities and impacts of `end`, and adds what obstacles received to `impulses`
/// (add_contact_impulses).
ImpactEnergy settle_impacts(const StepScene& scene, const StageMove& move, ClothState& end, ImpactSpace& space,
                            std::vector<ObstacleImpulse>& impulses);

}  // namespace percale
