#pragma once

#include "explicit_span.h"

namespace percale {

/// A span of `dt` seconds from a state to the present one, by a scheme that gives free vertices the momentum dt sum b_i f_i with
/// the forces f_i of some states. With the mean velocity w = (q - q_n)/dt
///     dE + sum b_i (material_i + Bregman term_i) + sum m (w - (v_n + v)/2) . (v - v_n) = sum w . (M (v - v_n) - dt sum b_i f_i),
/// the last being the work of pins and of what the solver left unbalanced.
struct LedgerSpan {
    const Vectors& positions;   // m, q_n
    const Vectors& velocities;  // m/s, v_n
    double dt;
};

/// Begins the account of a span.
void begin_span(World& world);

/// Takes forces without contact at a state, with a weight b. Damping by velocity.
void take_forces(World& world, const LedgerSpan& span, double weight, const ForcePlace& place);

/// sum w . (M (v - v_n) - dt sum b_i f_i), J, over free and over prescribed vertices.
struct Unbalanced {
    double free = 0.0, prescribed = 0.0;
};

/// Adds what the forces taken so far and the change of velocities mean to the ledger. What the scheme's forces make of the work
/// of pins and wind is left to the caller: that reported is another, of second order, and the difference is the integrator's.
Unbalanced account_span(World& world, const LedgerSpan& span);

/// The account of a step of an explicit scheme, whose stages follow from the start; without the work of pins and wind that is
/// reported.
void account_explicit(World& world, const LedgerSpan& span);

/// Work of the wind in a span that an implicit scheme other than backward Euler just solved, J, by the drag that its stages had.
double stage_wind_work(World& world, const LedgerSpan& span);

/// The account of a span that an implicit scheme other than backward Euler just solved; `work` of pins and obstacles, J, is
/// reported. BDF2 also gives momentum from the step before: the integrator's. In contact (TR-BDF2) all that contact forces take,
/// friction included, is in dissipated_contact.
void account_stages(World& world, const LedgerSpan& span, double work);

}  // namespace percale
