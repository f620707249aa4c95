#pragma once

#include <limits>

#include "forces/elastic.h"
#include "impacts.h"
#include "plan/scene.h"
#include "solve/explicit_update.h"
#include "solve/newton.h"
#include "step_state.h"
#include "support/deadline.h"

namespace percale {

/// A piece of a step that is solved at once.
struct Span {
    const StepScene& scene;
    const Vectors& step_start;  // m, positions when the step began: pins go straight on from there to their targets
    StepFraction fraction;      // of the step
    bool last_try = false;      // what has used up its iterations is taken as it is

    double length() const { return scene.settings.time_step * (fraction.to - fraction.from); }  // s
    /// The fraction of the step at a place of the span, 0 ... 1.
    double at(double place) const { return fraction.from + place * (fraction.to - fraction.from); }
};

/// What became of a span. The state it leads to is kept or dropped by who asked for it.
struct SpanResult {
    SpanEnd end = SpanEnd::solved;
    double error = 0.0;  // m, estimated, of positions; of explicit schemes in adaptive steps only
    StepEnergy flows;    // J, work and, with the ledger, where energy went; nothing that is stored
    // Sums and extremes over its stages; the residual is the last one's.
    int newton_iterations = 0, linear_iterations = 0, line_search_cuts = 0;
    double residual = 0.0, smallest_fraction = 1.0, contact_stiffness = 0.0;
    bool out_of_time = false;  // a stage was ended by the time budget

    bool is_usable(bool last_try) const {
        return end == SpanEnd::solved || ((last_try || out_of_time) && end == SpanEnd::not_converged);
    }
};

/// Memory that steps use again and again, so that none is allocated once sizes are known. `newton.current` keeps forces and
/// contacts of the last stage that was solved.
struct Workspace {
    NewtonSpace newton;
    ExplicitSpace explicit_space;
    StageBase base;
    Vectors targets;                  // m, of prescribed vertices at the end of the coming stage
    std::vector<ObstacleFlow> flows;  // of each obstacle
    StepWind wind;
    ClothState middle;                // between the stages of TR-BDF2
    StepState half;                   // between the halves of an adaptive explicit step
    Vectors acceleration;             // m/s^2, where a stage begins
    std::vector<double> rest_length;  // m, of springs at the time of a stage
    ImpactSpace impacts;
    Vectors scratch;
    ClothState ledger_stage;  // in which the ledger takes forces
    Vectors impulse;          // N s, that forces taken so far give
    Vectors forces;           // N
    ElasticSpace elastic;
    StepState ends[3];  // of spans that are kept or dropped (solve_step.cpp)
    StageTimes times;
    int iterations_left = std::numeric_limits<int>::max();  // of Newton's, that the step may still take
    TimeBudget time;                                        // that is left of the step's
};

}  // namespace percale
