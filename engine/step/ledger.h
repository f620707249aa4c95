#pragma once

#include "world.h"

namespace percale {

/// Adds to the step's ledger what became of energy in the part that backward Euler just solved, of `dt` in s:
///     v . [M (v - v_n) - dt f(q, v)] summed over all vertices is the work of the residual and of pins, and is also
///     dE + material + friction + contact + (1/2 |v - v_n|_M^2 + Bregman terms of all potentials) - work of obstacles.
/// Every entry is computed from its own forces, none as what the others leave.
void account_part(World& world, double dt);

/// Writes the imbalance of the accepted step, whose energies are in the report.
void close_ledger(World& world, const StepEnergy& start);

}  // namespace percale
