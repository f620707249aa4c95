#pragma once

#include "span.h"

namespace percale {

/// The two ends of a span that was just solved, and what lies between them where its scheme has two stages.
struct SpanStates {
    const StepState& start;
    StepState& end;
    const ClothState* middle = nullptr;  // between two stages; null: one stage
    double obstacle_work = 0.0;          // J, by the contacts of the stages
};

/// What became of energy in a span of length dt from (q_n, v_n) to (q, v), by a scheme that gives free vertices the momentum dt
/// sum b_i f_i with the forces f_i of its stages. With the mean velocity w = (q - q_n)/dt
///     dE + sum b_i (material_i + Bregman term_i) + sum m (w - (v_n + v)/2) . (v - v_n) = sum w . (M (v - v_n) - dt sum b_i f_i),
/// the right side summed over prescribed vertices being the work of pins, over free ones what the solver and contact left.
/// Every entry is computed from its own forces, none as what the others leave, but contact by TR-BDF2, where all that contact
/// forces take, friction included, is in dissipated_contact. BDF2 also gives momentum from the span before: the integrator's.
/// The work of pins is that right side in backward Euler; in schemes of second order it goes by the mean of the forces at both
/// ends, and the difference is the integrator's. Adds to flows.work, with the ledger to its other entries, and sets the energy of
/// contact of states.end.
void account_implicit(const Span& span, const SpanStates& states, Workspace& work, StepEnergy& flows);

/// The same of a step of an explicit scheme, whose stages follow from the start. The work of pins and wind is left to the caller,
/// who adds it (script_work) to flows.work and to flows.dissipated_integrator.
void account_explicit(const Span& span, const SpanStates& states, Workspace& work, StepEnergy& flows);

}  // namespace percale
