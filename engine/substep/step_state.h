#pragma once

#include "contact/contact_law.h"
#include "model/cloth_state.h"
#include "obstacle_impulse.h"
#include "step_control.h"

namespace percale {

/// What schemes remember of earlier substeps.
struct SchemeHistory {
    ClothState earlier;           // one substep before the present state; positions and velocities
    double earlier_length = 0.0;  // s, from there to the present state; 0: unknown
    Vec3Arrays acceleration;      // m/s^2, of BDF2 at the present state
    Vec3Arrays unbalanced;        // N, the solver's residual M a - f there; empty: unknown

    /// The present state does not follow from the last substep.
    void forget() {
        earlier_length = 0.0;
        for (Vec3Arrays* vectors : {&earlier.positions, &earlier.velocities, &acceleration, &unbalanced}) vectors->resize(0);
    }
};

/// The state of the cloth and of its solution that a step changes and the next one starts from. It is saved as it is, but for
/// `contact`, and without `impulses`.
struct StepState {
    ClothState cloth;
    SchemeHistory past;
    ContactWarmStart contact;
    double contact_energy = 0.0;  // J
    StepControl control;          // of adaptive steps
    double time = 0.0;            // s
    double time_error = 0.0;      // s, accumulated rounding of the time
    /// Impulses on each obstacle in the step under way, or in the last one; empty unless requested (World::keeps_impulses).
    std::vector<ObstacleImpulse> impulses;
};

/// Copies a substep's start to `end`, except the cloth.
inline void begin_end(const StepState& start, StepState& end) {
    end.past = start.past;
    end.contact = start.contact;
    end.contact_energy = start.contact_energy;
    end.control = start.control;
    end.time = start.time;
    end.time_error = start.time_error;
    end.impulses = start.impulses;
}

}  // namespace percale
