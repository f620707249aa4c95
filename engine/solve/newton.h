#pragma once

#include <limits>

#include "direction.h"
#include "implicit_stage.h"
#include "percale/report.h"
#include "subset_space.h"
#include "support/deadline.h"

namespace percale {

enum class NewtonEnd {
    converged,
    iterations_used,  // pins and obstacles have arrived, the tolerance is not met: iterations, work or time used up, or cancelled
    blocked,          // pins or obstacles have not arrived at the end of their motion
    not_finite,
};

struct NewtonReport {
    NewtonEnd end = NewtonEnd::converged;
    bool out_of_time = false;  // ended by the time budget, before it was solved
    int newton_iterations = 0;
    int linear_iterations = 0;
    int line_search_cuts = 0;  // backtracks of line searches; clamps by the detector do not count
    double residual = 0.0;     // relative to the first, or to the impulse of gravity where that is larger
    double smallest_fraction = 1.0;
    double largest_stiffness = 0.0;  // N/m, of contact
    double time_error = 0.0;         // m, estimated local error of the time discretisation: mass-weighted RMS, of the worst cloth
};

/// The output of a stage: the cloth at its end and the warm start of contact. Both keep their values where the stage is blocked
/// or not finite.
struct StageEnd {
    ClothState& cloth;
    ContactWarmStart& contact;
};

/// Work space of solves, kept from step to step so that nothing is allocated once sizes are known. Only the solver chosen last
/// (StepSolver::choice) has an influence on later stages.
struct NewtonSpace {
    StageSpace stage;
    NewtonSystem system;
    StagePoint current, trial;                              // the point that the search has reached, and one ahead of it
    Direction direction;                                    // from the one to the other
    BodyStates bodies;                                      // in the rounds of contact correction
    std::vector<double> contact_accelerations[2];           // m/s^2, of each body before and after a line
    SubsetSpace subsets;                                    // of the last iteration that looked for one
    int iterations_left = std::numeric_limits<int>::max();  // of StepSettings::work_limit, for one stage
    TimeBudget time;                                        // the rest of the step's
};

/// Solves one stage from stage.start by Newton's method with the matrix of linear/block_matrix.h, which sums all terms, a linear
/// solver (conjugate gradient or a factorisation) and a line search; every move is clamped to what the detector proves free of
/// crossing. Stops by settings.newton_tolerance, or (auto) when the change by the last iteration, dt sqrt(-r . dv / m) in metres
/// with the mass m of the cloth, is at most newton_error_ratio of the stage's time error plus a floor in every cloth, and
/// likewise at its worst vertex (change_is_small), and contact forces have settled (contact_is_settled), or when a line search is
/// stuck. space.current keeps forces and contacts of the end.
NewtonReport solve_stage(const ImplicitStage& stage, NewtonSpace& space, StageEnd end, StageTimes& times);

}  // namespace percale
