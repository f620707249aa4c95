#include "step_plan.h"

#include <algorithm>

#include "forces/total_force.h"
#include "schemes/schemes.h"

namespace percale {
namespace {

bool meets_cloth(const SceneFacts& facts) {
    return std::any_of(facts.cloths.begin(), facts.cloths.end(),
                       [](const ClothFacts& cloth) { return cloth.fabric.self_contact; });
}

void add_contacts(const StepPlan& plan, const SceneFacts& facts, std::vector<Skip>& skipped) {
    if (!plan.contacts) {
        skipped.push_back({"contact detection, contact constraints, clamps and predicted positions",
                           facts.obstacles == 0 ? "the scene has no obstacle" : "the scene has no cloth"});
    }
    for (const ClothFacts& cloth : facts.cloths) {
        if (!cloth.fabric.self_contact) skipped.push_back({"contact of " + cloth.name + " with cloth", "self_contact is false"});
    }
    for (const auto& [cloths, pair] : facts.pairs.said()) {
        if (pair.contact) continue;
        const std::string &first = facts.cloths[cloths[0]].name, &second = facts.cloths[cloths[1]].name;
        skipped.push_back(
            {"contact of " + first + " with " + (cloths[0] == cloths[1] ? "itself" : second), "the pair's contact is false"});
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

std::string why_unmeasured(const StepSettings& settings) {
    return settings.measure == StepMeasures::none ? "step.measure is none" : "nothing reads them after each step";
}

void add_measures(const StepPlan& plan, const StepSettings& settings, std::vector<Skip>& skipped) {
    if (!plan.measures) {
        skipped.push_back({"energy, strain and speed of each step", why_unmeasured(settings)});
    } else if (!plan.gravity_energy) {
        skipped.push_back({"energy of gravity", "gravity is zero"});
    }
    if (!plan.ledger) {
        skipped.push_back({"ledger of energy", plan.measures ? "step.measure is all" : why_unmeasured(settings)});
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
    plan.measures = settings.measure == StepMeasures::all || settings.measure == StepMeasures::ledger || everything;
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
    const ForceFacts forces{facts.cloths, plan.wind || facts.changes.wind, facts.springs.seam > 0};
    for (const ForceTerm* term : force_terms()) term->add_skips(forces, skipped);
    if (plan.scheme == Scheme::backward_euler && plan.damping != settings.damping_form) {
        skipped.push_back({"start lengths of springs in each step", "spring_damping is 0 N s/m"});
    }
    add_solver(plan, facts_of(plan.scheme).word, skipped);
    add_measures(plan, settings, skipped);
    return skipped;
}

}  // namespace percale
