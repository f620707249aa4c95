#pragma once

#include "substep.h"

namespace percale {

/// The two ends of a substep that was just solved, and the state between them where its scheme has two stages.
struct SubstepStates {
    const StepState& start;
    StepState& end;
    const ClothState* middle = nullptr;  // between two stages; null: one stage
    double obstacle_work = 0.0;          // J, by the contacts of the stages
};

/// The energy balance of a substep of length dt from (q_n, v_n) to (q, v). Its scheme gives free vertices the momentum dt sum b_i
/// f_i, with quadrature weights b_i and the forces f_i of its stages (with contact for backward Euler only). Stage i has the loss
/// D_i by damping (SpringLoss::material) and the integrator's loss B_i, Bregman terms and the rest of damping's work
/// (SpringLoss::integrator, shape_loss). With the mean velocity w = (q - q_n)/dt
///     dE + sum b_i (D_i + B_i) + sum m (w - (v_n + v)/2) . (v - v_n) = sum w . (M (v - v_n) - dt sum b_i f_i),
/// the right side summed over prescribed vertices being the work of pins, over free ones the residuals of solver and contact.
/// Every entry is computed from its own forces, except two remainders: the work of all contact forces in TR-BDF2, friction
/// included, which is in dissipated_contact, and the momentum that BDF2 takes from the previous substep, which counts as the
/// integrator's. The work of pins is that right side in backward Euler; in schemes of second order it uses the mean of the forces
/// at both ends, and the difference is the integrator's. Adds the work of seams, obstacles, wind and pins to flows.work, also
/// without the ledger, and with it the other entries; sets the energy of contact of states.end.
void account_implicit(const Substep& substep, const SubstepStates& states, Workspace& work, StepEnergy& flows);

/// The same for a step of an explicit scheme, whose stages follow from the start. The work of pins and wind is left to the
/// caller, who adds it (script_work) to flows.work and to flows.dissipated_integrator.
void account_explicit(const Substep& substep, const SubstepStates& states, Workspace& work, StepEnergy& flows);

}  // namespace percale
