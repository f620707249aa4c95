#pragma once

#include <string>
#include <vector>

#include "percale/settings.h"

namespace percale {

/// A part of the work that is left out, and why.
struct Skip {
    std::string what, why;
};

/// What the caller knows to change later on that the simulation has not been told yet.
struct ScriptedChanges {
    bool obstacles = false;  // move
    bool pins = false;       // move, come or go
    bool gravity = false;    // changes
};

/// Springs by kind.
struct SpringCounts {
    int structural = 0, shear = 0, bend = 0;

    int total() const { return structural + shear + bend; }
};

/// What the steps of a simulation will be made of, known without running one.
struct ScenePlan {
    Scheme scheme = Scheme::backward_euler;  // the one chosen, where the settings leave it open
    std::string scheme_reason = {};          // why, where they do
    double stable_step = 0.0;                // s, longest stable one of the scheme, estimated; infinity if it is always stable
    std::vector<std::string> warnings = {};  // what will go wrong or be inexact
    int vertices = 0;
    int pinned_vertices = 0;
    SpringCounts springs = {};
    int obstacles = 0;
    long obstacle_triangles = 0;
    std::vector<Skip> skipped = {};
    double memory_bytes = 0.0;        // predicted; model/plan_costs.h says how
    double evaluations_a_step = 0.0;  // predicted cost of a step, in evaluations of all spring forces
};

}  // namespace percale
