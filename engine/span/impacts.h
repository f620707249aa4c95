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
    double impulse_time = 0.0;   // s: what contact gave is its force times this
    /// In the stages of TR-BDF2 contact gives twice what stops cloth: there a point that is pressed leaves no faster than it went
    /// in the mean of the stage, be it in an impact or not.
    bool keeps_to_mean = false;
    /// m/s, where the scheme goes on with the change of the stage before, contact's included: what it starts from.
    const Vectors* extrapolated = nullptr;
    /// By how much what the stage gives counts in the span: the second stage of TR-BDF2 goes on with the first one's change.
    double weight = 1.0;
};

/// A vertex whose velocity has jumped.
struct ThrownVertex {
    int vertex = -1, obstacle = -1;
    Vec3 direction = Vec3::Zero();  // unit
};

/// Memory that settling uses again and again.
struct ImpactSpace {
    std::vector<std::size_t> order;  // of rows
    std::vector<Impact> found;
    std::vector<ThrownVertex> thrown;  // by the last settling
};

/// What settling did to energy, J.
struct ImpactFlows {
    double work = 0.0;  // of obstacles on the cloth
    double loss = 0.0;  // what the cloth lost beyond that
};

/// Restitution (Newton's law of impact). Contact stops what comes; it does not make it leave, however stiff it is and however
/// long the step. What came at a speed u, faster than gravity makes it in the stage (and 2 h a second), is in an impact. Once it
/// has been stopped it leaves an obstacle with restitution e at e u, and beside that, until u has faded, it loses of the speed at
/// which it leaves what contact gave it. Row by row, the nearest first. Contacts that last are left alone. Changes velocities and
/// impacts of `end`, and adds what obstacles were given to `impulses` (add_contact_impulses).
ImpactFlows settle_impacts(const StepScene& scene, const StageMove& move, ClothState& end, ImpactSpace& space,
                           std::vector<ObstacleImpulse>& impulses);

}  // namespace percale
