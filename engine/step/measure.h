#pragma once

#include "substep/substep.h"

namespace percale {

/// Energies of a state, J; contact energy as the last substep left it.
StepEnergy energy_of(const StepScene& scene, const StepState& state);

/// Largest speed of a vertex, m/s.
double largest_speed(const Vec3Arrays& velocities, int count);

/// Whether all positions and velocities are finite.
bool all_finite(const Compute& compute, const ClothState& cloth);

/// Fills a step's report with energies, strain, speed and contacts at its end.
class StepMeasure {
public:
    /// The step begins from `state`; `work`, J, is the work of changes of the scene.
    StepMeasure(const StepScene& scene, const StepState& state, double work);

    /// For the state that the step led to. The report holds the flows of energy already; the ledger's imbalance is added.
    void accepted(const StepState& state, Workspace& work, StepReport& report) const;

    /// For a failed step: energies, strain and speed of the state that was kept; no contacts, nothing near.
    void kept(const StepState& state, StepReport& report) const;

private:
    void set_state(const StepState& state, StepReport& report) const;

    const StepScene& scene_;
    double start_energy_ = 0.0;  // J, total; with the ledger only
};

}  // namespace percale
