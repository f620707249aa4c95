#include "step_plan.h"

#include <algorithm>

#include "schemes/schemes.h"

namespace percale {
namespace {

void add_springs(const ClothFacts& cloth, std::vector<Skip>& skipped) {
    const SpringConstants& springs = cloth.fabric.springs;
    const bool triangles = cloth.fabric.has_moduli() && cloth.fabric.membrane == Membrane::triangle_springs;
    if (!triangles) {
        skipped.push_back({"triangle springs of " + cloth.name,
                           cloth.fabric.has_moduli() ? "membrane is van_gelder" : "stretch_stiffness is not set"});
    }
    if (cloth.fabric.has_moduli()) {
        return skipped.push_back({"springs of " + cloth.name + " other than along edges", "stretch_stiffness is set"});
    }
    if (springs.structural == 0.0) skipped.push_back({"structural springs of " + cloth.name, "springs.structural is 0 N/m"});
    if (!cloth.grid) {
        skipped.push_back({"shear springs of " + cloth.name, "a free mesh has none"});
    } else if (springs.shear == 0.0) {
        skipped.push_back({"shear springs of " + cloth.name, "springs.shear is 0 N/m"});
    }
    if (springs.bend == 0.0) skipped.push_back({"bending springs of " + cloth.name, "springs.bend is 0 N/m"});
}

bool meets_cloth(const SceneFacts& facts) {
    return std::any_of(facts.cloths.begin(), facts.cloths.end(),
                       [](const ClothFacts& cloth) { return cloth.fabric.self_contact; });
}

void add_contacts(const StepPlan& plan, const SceneFacts& facts, std::vector<Skip>& skipped) {
    if (!plan.contacts) {
        skipped.push_back({"contact detection, rows, cuts and predicted positions",
                           facts.obstacles == 0 ? "the scene has no obstacle" : "the scene has no cloth"});
    }
    for (const ClothFacts& cloth : facts.cloths) {
        if (!cloth.fabric.self_contact) skipped.push_back({"contact of " + cloth.name + " with cloth", "self_contact is false"});
    }
}

void add_motion(const StepPlan& plan, const SceneFacts& facts, std::vector<Skip>& skipped) {
    if (plan.contacts && facts.obstacles > 0 && !plan.still_obstacles && !facts.changes.obstacles) {
        skipped.push_back({"motion of obstacles", "no obstacle moves: their trees are built once"});
    }
    if (!plan.pins) {
        skipped.push_back({"motion and work of pins", "no vertex is pinned"});
    } else if (!plan.everything && !facts.changes.pins) {
        skipped.push_back({"work of pins", "no pin moves"});
    }
}

void add_solver(const StepPlan& plan, std::string_view scheme, std::vector<Skip>& skipped) {
    if (!plan.implicit) {
        skipped.push_back({"matrix and linear solve", std::string(scheme) + " is an explicit scheme"});
    } else if (plan.keep_work_space) {
        skipped.push_back({"a new matrix in each step", "springs stay the same: its pattern is kept, its blocks are refilled"});
    }
    if (!plan.solve) skipped.push_back({"the whole solve", "no vertex is free to move"});
}

void add_forces(const StepPlan& plan, const SceneFacts& facts, std::vector<Skip>& skipped) {
    for (const ClothFacts& cloth : facts.cloths) {
        if (cloth.fabric.bend_stiffness.value_or(0.0) == 0.0)
            skipped.push_back({"hinges of " + cloth.name, "bend_stiffness is not set or 0 N m"});
    }
    if (!plan.wind && !facts.changes.wind) skipped.push_back({"drag of the air", "no wind was ever set"});
    if (facts.springs.seam == 0) skipped.push_back({"closing of seams", "the scene has no seam"});
}

void add_measures(const StepPlan& plan, std::vector<Skip>& skipped) {
    if (!plan.measures) {
        skipped.push_back({"energy, strain and speed of each step", "step.measure is none"});
    } else if (!plan.gravity_energy) {
        skipped.push_back({"energy of gravity", "gravity is zero"});
    }
    if (!plan.ledger) {
        skipped.push_back({"ledger of energy", std::string("step.measure is ") + (plan.measures ? "all" : "none")});
    }
    if (plan.rest) skipped.push_back({"steps while all cloth is at rest", "nothing moves until something is changed"});
}

}  // namespace

StepPlan make_step_plan(const StepSettings& settings, const SceneFacts& facts) {
    const bool everything = !settings.skip;
    StepPlan plan;
    plan.everything = everything;
    plan.scheme = settings.scheme == Scheme::automatic ? facts.chosen : settings.scheme;
    plan.parts = facts.parts;
    plan.implicit = facts_of(plan.scheme).implicit;
    plan.contacts = facts_of(plan.scheme).contact && facts.cloth_vertices > 0 &&
                    (facts.obstacles > 0 || meets_cloth(facts) || (everything && facts.detector));
    const bool start_lengths = plan.scheme == Scheme::backward_euler && (facts.damped || everything);
    plan.damping = start_lengths ? settings.damping_form : DampingForm::velocity;
    plan.hinges = facts.springs.hinge > 0;
    plan.wind = settings.wind.has_value();
    plan.pins = facts.pinned_vertices > 0 || facts.changes.pins || everything;
    plan.still_obstacles = everything;
    plan.gravity_energy = settings.gravity != Vec3::Zero() || facts.changes.gravity || everything;
    plan.keep_work_space = !everything;
    plan.measures = settings.measure != StepMeasures::none || everything;
    plan.ledger = settings.measure == StepMeasures::ledger || everything;
    plan.rest = plan.implicit && !everything;
    plan.free_vertices = facts.pinned_vertices < facts.cloth_vertices;
    set_motion(plan, facts.changes);
    return plan;
}

void set_motion(StepPlan& plan, const ScriptedChanges& changes) {
    plan.obstacles_move = changes.obstacles;
    plan.pins_move = changes.pins;
    plan.solve = plan.free_vertices || plan.contacts || plan.pins_move || plan.everything;
    plan.pin_work = plan.measures && (changes.pins || plan.everything);
}

std::vector<Skip> skipped_by(const StepPlan& plan, const StepSettings& settings, const SceneFacts& facts) {
    std::vector<Skip> skipped;
    add_contacts(plan, facts, skipped);
    add_motion(plan, facts, skipped);
    for (const ClothFacts& cloth : facts.cloths) add_springs(cloth, skipped);
    if (plan.scheme == Scheme::backward_euler && plan.damping != settings.damping_form) {
        skipped.push_back({"start lengths of springs in each step", "spring_damping is 0 N s/m"});
    }
    add_forces(plan, facts, skipped);
    add_solver(plan, facts_of(plan.scheme).word, skipped);
    add_measures(plan, skipped);
    return skipped;
}

}  // namespace percale
