#pragma once

#include <string>
#include <vector>

#include "percale/settings.h"

namespace percale {

/// A part of the work that is left out, and the reason.
struct Skip {
    std::string what, why;
};

/// An expected failure or inaccuracy. `kind`: a short name that stays the same, unstable_step; `what`: a sentence, with numbers;
/// `fix`: what helps, "" where nothing is known.
struct PlanWarning {
    std::string kind = {}, what = {}, fix = {};

    /// "WHAT; FIX", or "WHAT" where there is no fix.
    std::string text() const { return fix.empty() ? what : what + "; " + fix; }
};

/// Later changes that the caller knows and the simulation does not yet.
struct ScriptedChanges {
    bool obstacles = false;  // move
    bool pins = false;       // move, come or go
    bool gravity = false;    // changes
    bool wind = false;       // begins to blow
};

/// Springs by kind, and hinges.
struct SpringCounts {
    int structural = 0, shear = 0, bend = 0;
    int hinge = 0;  // that resist bending, with bend_stiffness
    int seam = 0;
    int triangle = 0;  // of membranes, with stretch_stiffness; their edges are among the others

    int total() const { return structural + shear + bend + seam; }
};

/// The parts of the steps of a simulation, known without running one.
struct ScenePlan {
    Scheme scheme = Scheme::backward_euler;  // the one chosen, where the settings leave it open
    std::string scheme_word = {};            // as in a scene file
    std::string scheme_reason = {};          // why, where they do
    double stable_step = 0.0;                // s, longest stable one of the scheme, estimated; infinity if it is always stable
    std::vector<PlanWarning> warnings = {};
    int vertices = 0;
    int pinned_vertices = 0;
    SpringCounts springs = {};
    int obstacles = 0;
    long obstacle_triangles = 0;
    std::vector<Skip> skipped = {};
    double memory_bytes = 0.0;        // predicted; model/plan_costs.h describes how
    double evaluations_a_step = 0.0;  // predicted cost of a step, in evaluations of all spring forces

    std::vector<std::string> warning_texts() const {
        std::vector<std::string> texts;
        for (const PlanWarning& warning : warnings) texts.push_back(warning.text());
        return texts;
    }
};

}  // namespace percale
