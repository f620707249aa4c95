#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/cloth_model.h"
#include "model/seams.h"
#include "plan/step_plan.h"
#include "percale/contact.h"
#include "percale/report.h"
#include "rest_detection.h"
#include "schemes/explicit_update.h"
#include "solve/newton.h"
#include "step_control.h"

namespace percale {

struct ObstacleState {
    std::string name;
    Pose start, end;  // of the coming step
    int triangles = 0;
    bool settled = true;  // the detector knows that it stays at `start`
};

/// What the script says about the coming step.
struct Script {
    AlignedVector<double> free;  // 1, or 0 where pinned and in the padding
    Vectors pin_targets;         // m, at the end of the coming step; meaningful where pinned
    std::vector<ObstacleState> obstacles;
    std::vector<Seam> seams;
};

/// What callers see, one entry a vertex in the user's order. Positions and masses are kept only if some cloth has another order.
struct UserViews {
    std::vector<Vec3> positions;   // m
    std::vector<Vec3> velocities;  // m/s, of the cloths that were asked for
    std::vector<double> masses;    // kg
};

/// What implicit schemes other than backward Euler, and adaptive steps, need beside it.
struct StageSpace {
    StageBase base;
    ClothState start, earlier;    // of the span being solved, and one before it; without points
    double earlier_length = 0.0;  // s, from `earlier` to the present state; 0: nothing is known of it
    Vectors acceleration;         // m/s^2, at the start of the stage; of BDF2 kept to the next step
    Vectors unbalanced;           // N, M a - f that the solver left at the present state; empty: nothing is known of it
    Vectors scratch;
    std::vector<std::size_t> row_order;  // of contact rows; work space
    double obstacle_work = 0.0;          // J, of the span
    double error = 0.0;                  // m, estimated, of the spans since it was set to 0
    ClothState attempt;                  // before an adaptive attempt
    Vectors attempt_unbalanced;          // likewise
    StepControl control;

    /// The present state does not follow from the last solve.
    void forget() {
        earlier_length = 0.0;
        unbalanced.resize(0);
    }
};

/// What the ledger of energy goes by within a step.
struct LedgerSpace {
    double start_energy = 0.0;  // J, in all, when the step began
    double contact = 0.0;       // J, energy of contact where the coming part begins
    ClothState stage;           // in which forces are taken; without points
    ClothState start;           // of a part of an explicit step; likewise
    Vectors impulse;            // N s, that the forces taken so far give
    Vectors still, forces;      // work space
};

/// Everything one simulation holds.
struct World {
    std::unique_ptr<ThreadPool> pool;  // with more than one thread
    Compute compute;
    StepSettings settings;
    ClothModel model;
    ClothState state;
    Script script;
    StepPlan plan;
    bool plan_outdated = true;  // the scene has changed since the plan was made
    RestState rest;
    std::unique_ptr<ContactDetector> detector;
    double time = 0.0;        // s
    double time_error = 0.0;  // s, what rounding has added to it
    bool changed = true;      // cloth or obstacles were added since the last preparation

    // Work space and what the running step found so far.
    NewtonSpace newton;
    ExplicitSpace explicit_space;
    StageSpace stages;
    ClothState before;  // the state at the start of the running step
    Vectors part_targets;
    std::vector<ObstacleFlow> flows;
    StepWind wind;
    StepFraction part;            // of the step, being solved
    double seam_work = 0.0;       // J, of closing seams in it
    double contact_energy = 0.0;  // J, of the current state
    double contact_dt = 0.0;      // s, that the contact stiffness was last made for
    LedgerSpace ledger;
    UserViews views;
    StepReport report;
};

}  // namespace percale
