#pragma once

#include "contact/contact_law.h"
#include "model/cloth_state.h"
#include "obstacle_impulse.h"
#include "step_control.h"

namespace percale {

/// What schemes remember of earlier spans.
struct SchemeMemory {
    ClothState earlier;           // one span before the present state; positions and velocities
    double earlier_length = 0.0;  // s, from there to the present state; 0: nothing is known of it
    Vectors acceleration;         // m/s^2, of BDF2 at the present state
    Vectors unbalanced;           // N, M a - f that the solver left there; empty: nothing is known of it

    /// The present state does not follow from the last span.
    void forget() {
        earlier_length = 0.0;
        for (Vectors* vectors : {&earlier.positions, &earlier.velocities, &acceleration, &unbalanced}) vectors->resize(0);
    }
};

/// All of the cloth and of its solution that a step changes and the next one goes by. Saved; but for `contact`, as it is, and
/// without `impulses`.
struct StepState {
    ClothState cloth;
    SchemeMemory past;
    ContactMemory contact;
    double contact_energy = 0.0;  // J
    double contact_dt = 0.0;      // s, that the contact stiffness was last made for
    StepControl control;          // of adaptive steps
    double time = 0.0;            // s
    double time_error = 0.0;      // s, what rounding has added to it
    /// Of each obstacle in the step under way, or in the last one; empty unless somebody asks (World::keeps_impulses).
    std::vector<ObstacleImpulse> impulses;
};

/// `end` begins as a span's start: all but the cloth.
inline void begin_end(const StepState& start, StepState& end) {
    end.past = start.past;
    end.contact = start.contact;
    end.contact_energy = start.contact_energy;
    end.contact_dt = start.contact_dt;
    end.control = start.control;
    end.time = start.time;
    end.time_error = start.time_error;
    end.impulses = start.impulses;
}

}  // namespace percale
