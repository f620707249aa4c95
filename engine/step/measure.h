#pragma once

#include "span/span.h"

namespace percale {

/// Energies of a state, J; contact as the last span left it.
StepEnergy energy_of(const StepScene& scene, const StepState& state);

/// Of a vertex, m/s.
double largest_speed(const Vectors& velocities, int count);

/// No position or velocity is infinite or NaN.
bool all_finite(const Compute& compute, const ClothState& cloth);

/// Fills a step's report with what its end is like: energies, strain, speed, contacts.
class StepMeasure {
public:
    /// The step begins from `state`, what changes of the scene took in `work`, J.
    StepMeasure(const StepScene& scene, const StepState& state, double work);

    /// The state that the step led to. Flows of energy are in the report already; the ledger's imbalance comes in.
    void accepted(const StepState& state, Workspace& work, StepReport& report) const;

    /// After a failed step: energies, strain and speed of the state that was kept; no contacts, nothing near.
    void kept(const StepState& state, StepReport& report) const;

private:
    void set_state(const StepState& state, StepReport& report) const;

    const StepScene& scene_;
    double start_energy_ = 0.0;  // J, in all; with the ledger only
};

}  // namespace percale
