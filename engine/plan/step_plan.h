#pragma once

#include <string>
#include <vector>

#include "model/cloth_facts.h"
#include "percale/cloth_pairs.h"
#include "percale/plan.h"
#include "percale/settings.h"

namespace percale {

/// The needs of a step of this scene, decided once when the scene changes. Only motion is known step by step (set_motion).
struct StepPlan {
    Scheme scheme = Scheme::backward_euler;
    int parts = 1;                // equal parts into which an explicit scheme divides a step
    bool implicit = true;         // Newton and a matrix; otherwise an explicit update
    bool free_vertices = true;    // there are vertices that are not pinned
    bool solve = true;            // the coming step: a vertex is free, a pin moves, or contact has to be checked
    bool contacts = false;        // detector: lists, constraints, clamps
    bool obstacles_move = false;  // in the coming step
    bool pins_move = false;       // in the coming step
    DampingForm damping = DampingForm::length_rate;
    bool hinges = false;          // some cloth has bending stiffness
    bool wind = false;            // there is air
    bool seams_close = false;     // in the coming step or later
    bool pins = true;             // a vertex is pinned: targets are compared with positions
    bool pin_work = false;        // work of pins in the coming step is summed
    bool still_obstacles = true;  // obstacles that stay where the detector knows them are passed to it, too
    bool gravity_energy = true;   // it is measured
    bool keep_work_space = true;  // pattern of the matrix and all sizes stay from step to step
    bool measures = true;         // energy, strain and speed
    bool ledger = false;          // flows of energy
    bool rest = true;             // cloth at rest falls asleep
    bool everything = false;      // nothing is skipped that could be done

    /// Whether anything external moves in the coming step.
    bool something_moves() const { return pins_move || obstacles_move || seams_close; }

    bool operator==(const StepPlan&) const = default;
};

/// The facts from which the plan is made.
struct SceneFacts {
    Scheme chosen = Scheme::backward_euler;  // where the settings leave it open
    int parts = 1;                           // StepPlan::parts
    int cloth_vertices = 0;
    int pinned_vertices = 0;
    int cloth_triangles = 0;
    SpringCounts springs = {};
    bool damped = true;  // a spring has damping
    int obstacles = 0;
    long obstacle_triangles = 0;
    bool detector = false;         // there is one, with or without obstacles
    ScriptedChanges changes = {};  // known changes
    std::vector<ClothFacts> cloths = {};
    ClothPairs pairs = {};
};

/// Explicit schemes use velocity damping, whatever the setting is for the implicit ones. Without damping the velocity form is
/// planned, too: it is the same force and needs no start lengths.
StepPlan make_step_plan(const StepSettings& settings, const SceneFacts& facts);

/// Enters what moves in the coming step.
void set_motion(StepPlan& plan, const ScriptedChanges& changes);

/// Everything that a plan leaves out, with reasons; the plan must be that of the settings and facts.
std::vector<Skip> skipped_by(const StepPlan& plan, const StepSettings& settings, const SceneFacts& facts);

}  // namespace percale
