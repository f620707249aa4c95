#pragma once

#include "implicit_stage.h"
#include "percale/report.h"

namespace percale {

enum class NewtonEnd {
    converged,
    iterations_used,  // arrived, but the error is above the target
    blocked,          // pins or obstacles could not reach the end of their path
    not_finite,
};

struct NewtonReport {
    NewtonEnd end = NewtonEnd::converged;
    bool out_of_time = false;  // ended by the time budget, at some state on the way
    int newton_iterations = 0;
    int linear_iterations = 0;
    int line_search_cuts = 0;
    double residual = 0.0;  // relative to the first, or to gravity's impulse where that is larger
    double smallest_fraction = 1.0;
    double largest_stiffness = 0.0;  // N/m, of contact
    double time_error = 0.0;         // m, estimated error of the stage's length, in the mean of the worst cloth
};

/// Where a stage begins to act and what it leaves: the cloth at its end and what contact hands on. Both stay as they are where
/// the stage is blocked or not finite.
struct StageEnd {
    ClothState& cloth;
    ContactMemory& contact;
};

/// Solves one stage from stage.start. Newton with the positive definite matrix of forces/springs.h, conjugate gradient, every
/// move cut to what the detector proves free of crossing, and a line search. Stops by settings.newton_tolerance, or (auto) when
/// what the last iteration changed, in metres, dt sqrt(dv . b / m), is at most newton_share of the stage's time error in every
/// cloth. space.current keeps forces and contacts of the end.
NewtonReport solve_stage(const ImplicitStage& stage, NewtonSpace& space, StageEnd end, StageTimes& times);

}  // namespace percale
