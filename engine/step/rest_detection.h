#pragma once

#include <optional>
#include <vector>

#include "model/vec3_arrays.h"
#include "percale/report.h"
#include "plan/scene.h"

namespace percale {

/// How long a cloth has been still.
struct ClothRest {
    double still_time = 0.0;  // s
    bool asleep = false;
};

struct RestState {
    std::vector<ClothRest> cloths;
    Vec3Arrays anchor;                // m, where each vertex was when its cloth became still
    std::optional<double> potential;  // J, after the last step (damp_kinetic_energy)
    bool asleep = false;              // all cloths: steps are not solved
    StepReport figures;               // of the last step that was solved
};

/// Called after a good step: measures how long each cloth has been still, and lets all fall asleep (velocities become zero) once
/// each one is at rest. A cloth is at rest if for 0.5 s
/// - no vertex was farther than 0.002 of the thickness, or 0.5 s times StepSettings::rest_speed, from where it was when that time
///   began, and now
/// - the net force on each free vertex (springs, gravity, contact, friction), mass times the velocity change of the step over its
///   length, is below 0.02 of its weight (without gravity: below the force that moves it by that distance in that time),
/// while no pin and no obstacle moved and every step converged. There are two conditions, as a swing is slow where it turns and
/// balanced where it is fast. `velocities`: at the start of the step, m/s. Falling asleep changes velocities and the report.
void update_rest(const StepScene& scene, const Vec3Arrays& velocities, ClothState& cloth, RestState& rest, StepReport& report);

/// To be called by everything that changes the scene.
void wake(RestState& rest);

/// A step of a simulation asleep: time passes, the state stays, the report repeats the last figures.
StepReport sleep_through(const RestState& rest, double time);

}  // namespace percale
