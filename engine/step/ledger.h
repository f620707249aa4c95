#pragma once

#include "world.h"

namespace percale {

/// The step begins, with what changes of the scene took already in the report.
void begin_ledger(World& world);

/// Adds to the step's ledger what became of energy in the span that an implicit scheme just solved, of `dt` in s; `work` of
/// pins, obstacles and wind during it is reported, J. Every entry is computed from its own forces, none as what the others leave.
/// Backward Euler:
///     v . [M (v - v_n) - dt f(q, v)] summed over all vertices is the work of the residual and of pins, and is also
///     dE + material + friction + contact + (1/2 |v - v_n|_M^2 + Bregman terms of all potentials) - work of obstacles.
/// The others: span_ledger.h.
void account_implicit(World& world, double dt, double work);

/// Writes the imbalance of the accepted step, whose energies are in the report.
void close_ledger(World& world);

}  // namespace percale
