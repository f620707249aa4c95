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

/// A part of a step that one application of the time integrator advances, in one or more stages.
struct Substep {
    const StepScene& scene;
    const Vec3Arrays& step_start;  // m, positions when the step began: pins move straight from there to their targets
    StepFraction fraction;         // of the step
    bool last_try = false;         // a result that has used up its iterations is accepted as it is

    double length() const { return scene.settings.time_step * (fraction.to - fraction.from); }  // s
    /// The fraction of the step at a place of the substep, 0 ... 1.
    double at(double place) const { return fraction.from + place * (fraction.to - fraction.from); }
};

/// The result of a substep. Its caller keeps or drops the state that it leads to.
struct SubstepResult {
    SubstepOutcome end = SubstepOutcome::solved;
    double error = 0.0;  // m, estimated, of positions; of explicit schemes in adaptive steps only
    StepEnergy flows;    // J, work and, with the ledger, the other flows of energy; no stored energies
    // Sums and extremes over its stages; the residual is the last one's.
    int newton_iterations = 0, linear_iterations = 0, line_search_cuts = 0;
    double residual = 0.0, smallest_fraction = 1.0, contact_stiffness = 0.0;
    bool out_of_time = false;  // the time budget ended a stage

    bool is_usable(bool last_try) const {
        return end == SubstepOutcome::solved || ((last_try || out_of_time) && end == SubstepOutcome::not_converged);
    }
};

/// Work space that steps use again and again, so that none is allocated once sizes are known. `newton.current` keeps forces and
/// contacts of the last stage that was solved.
struct Workspace {
    NewtonSpace newton;
    ExplicitSpace explicit_space;
    StageBase base;
    Vec3Arrays targets;                            // m, of prescribed vertices at the end of the coming stage
    std::vector<ObstacleMotion> obstacle_motions;  // of each obstacle
    StepWind wind;
    ClothState middle;                // between the stages of TR-BDF2
    StepState half;                   // between the halves of an adaptive explicit step
    Vec3Arrays acceleration;          // m/s^2, where a stage begins
    std::vector<double> rest_length;  // m, of springs at the time of a stage
    ImpactSpace impacts;
    Vec3Arrays scratch;
    ClothState ledger_stage;  // at which the ledger evaluates forces
    Vec3Arrays impulse;       // N s, of the forces summed so far
    Vec3Arrays forces;        // N
    ElasticSpace elastic;
    StepState ends[3];  // of substeps that are kept or dropped (solve_step.cpp)
    StageTimes times;
    int iterations_left = std::numeric_limits<int>::max();  // Newton iterations that the step may still take
    TimeBudget time;                                        // left of the step's budget
};

}  // namespace percale
