#pragma once

#include <optional>
#include <vector>

#include "model/vectors.h"
#include "percale/report.h"
#include "plan/scene.h"

namespace percale {

/// For how long a cloth has been still.
struct ClothRest {
    double still_time = 0.0;  // s
    bool asleep = false;
};

struct RestState {
    std::vector<ClothRest> cloths;
    Vectors anchor;                   // m, where each vertex was when its cloth became still
    std::optional<double> potential;  // J, after the last step (damp_kinetic_energy)
    int unrest = 0;                   // how often it rose in the last steps
    double stopping = 0.0;            // s, for how long each step still stops cloth
    bool asleep = false;              // all cloths: steps are not solved
    StepReport figures;               // of the last step that was solved
};

/// After a good step: follows how long each cloth has been still, and lets all fall asleep (velocities become zero) once every
/// one is at rest. A cloth is at rest if for 0.5 s
/// - no vertex was farther than 0.002 of the thickness, or 0.5 s times StepSettings::rest_speed, from where it was when that time
///   began, and now
/// - the net force on each free vertex (springs, gravity, contact, friction), mass times what the step changed its velocity by
///   over its length, is below 0.02 of its weight (without gravity: below what moves it by that distance in that time),
/// while no pin and no obstacle moved and every step converged. Two conditions, as a swing is slow where it turns and
/// balanced where it is fast.
/// `velocities`: at the start of the step, m/s. Falling asleep changes velocities and the report.
void update_rest(const StepScene& scene, const Vectors& velocities, ClothState& cloth, RestState& rest, StepReport& report);

/// Whatever changes the scene calls this.
void wake(RestState& rest);

/// A step of a simulation asleep: time passes, the state stays, the report repeats the last figures.
StepReport sleep_through(const RestState& rest, double time);

}  // namespace percale
