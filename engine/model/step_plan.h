#pragma once

#include "percale/settings.h"

namespace percale {

/// What a step of this scene needs, decided once when the scene changes.
struct StepPlan {
    bool implicit = true;         // Newton and a matrix; otherwise an explicit update
    bool contacts = false;        // there is cloth and an obstacle: lists, rows, cuts
    bool obstacles_move = false;  // in the coming step
    bool pins_move = false;       // in the coming step
    DampingForm damping = DampingForm::length_rate;
};

/// What the plan is made from.
struct SceneFacts {
    int cloth_vertices = 0;
    int obstacles = 0;
    bool obstacles_move = false;
    bool pins_move = false;
};

/// Explicit schemes use velocity damping, whatever the setting says about the implicit ones.
StepPlan make_step_plan(const StepSettings& settings, const SceneFacts& facts);

}  // namespace percale
