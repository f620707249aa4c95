#include "planning.h"

#include <algorithm>

#include "forces/hinge_bending.h"
#include "plan_costs.h"
#include "schemes/schemes.h"
#include "step/rest_detection.h"
#include "scheme_choice.h"

namespace percale {
namespace {

bool pin_moves(const World& world, int i) {
    return world.script.free[i] == 0.0 && world.script.pin_targets.at(i) != world.state.positions.at(i);
}

bool pins_move(const World& world) {
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (pin_moves(world, i)) return true;
    }
    return false;
}

bool obstacles_move(const World& world) {
    return std::any_of(world.script.obstacles.begin(), world.script.obstacles.end(),
                       [](const ObstacleState& obstacle) { return obstacle.start != obstacle.end; });
}

bool seams_close(const World& world) {
    return std::any_of(world.script.seams.begin(), world.script.seams.end(),
                       [&](const Seam& seam) { return seam.closes_after(world.time - world.settings.time_step); });
}

SpringCounts count_springs(const SpringNetwork& springs) {
    SpringCounts counts;
    for (const SpringKind kind : springs.kind) {
        if (kind == SpringKind::structural) ++counts.structural;
        if (kind == SpringKind::shear) ++counts.shear;
        if (kind == SpringKind::bend) ++counts.bend;
        if (kind == SpringKind::seam) ++counts.seam;
    }
    return counts;
}

/// Pins that came or went change the energy of hinges beside them: work of whoever set them.
void update_clamps(World& world) {
    const double before = hinge_energy(world.model.hinges, world.state.positions);
    set_model_clamps(world.script.free, world.model);
    world.report.energy.work += hinge_energy(world.model.hinges, world.state.positions) - before;
}

/// All facts but what `automatic` chooses.
SceneFacts counted_facts(const World& world, const ScriptedChanges& to_come) {
    const ClothModel& model = world.model;
    SceneFacts facts;
    facts.cloth_vertices = model.vertex_count();
    for (int i = 0; i < facts.cloth_vertices; ++i) facts.pinned_vertices += world.script.free[i] == 0.0;
    facts.cloth_triangles = static_cast<int>(model.triangles.size());
    facts.springs = count_springs(model.springs);
    facts.springs.triangle = static_cast<int>(model.membrane.size());
    facts.damped = std::any_of(model.springs.damping.begin(), model.springs.damping.end(), [](double kd) { return kd > 0.0; });
    facts.obstacles = static_cast<int>(world.script.obstacles.size());
    for (const ObstacleState& obstacle : world.script.obstacles) facts.obstacle_triangles += obstacle.triangles;
    facts.detector = world.detector != nullptr;
    facts.changes = to_come;
    facts.changes.obstacles = to_come.obstacles || obstacles_move(world);
    facts.changes.pins = to_come.pins || pins_move(world);
    facts.springs.hinge = static_cast<int>(model.hinges.all.size());
    for (const ClothRange& cloth : model.cloths) facts.cloths.push_back({cloth.name, cloth.grid, cloth.fabric});
    return facts;
}

}  // namespace

SceneFacts scene_facts(const World& world, const ScriptedChanges& to_come) {
    SceneFacts facts = counted_facts(world, to_come);
    if (world.settings.scheme == Scheme::automatic) {
        const SchemeChoice choice = choose_scheme(world, facts);
        facts.chosen = choice.scheme;
        facts.parts = choice.parts;
    }
    return facts;
}

void update_plan(World& world) {
    if (world.plan_outdated) {
        world.plan = make_step_plan(world.settings, scene_facts(world));
        if (world.plan.hinges) update_clamps(world);
    }
    world.plan_outdated = false;
    ScriptedChanges now;
    now.obstacles = obstacles_move(world);
    now.pins = world.plan.pins && pins_move(world);
    set_motion(world.plan, now);
    world.plan.seams_close = seams_close(world);
}

StepPlan plan_again(const World& world, const StepPlan& known) {
    SceneFacts facts = counted_facts(world, {});
    facts.chosen = known.scheme;
    facts.parts = known.parts;
    StepPlan plan = make_step_plan(world.settings, facts);
    set_motion(plan, {.obstacles = known.obstacles_move, .pins = known.pins_move});
    plan.seams_close = known.seams_close;
    return plan;
}

void scene_changed(World& world) {
    world.plan_outdated = true;
    world.stages.forget();
    wake(world.rest);
}

ScenePlan scene_plan(const World& world, const ScriptedChanges& to_come) {
    const SceneFacts facts = scene_facts(world, to_come);
    const StepPlan plan = make_step_plan(world.settings, facts);
    const bool open = world.settings.scheme == Scheme::automatic;
    return {.scheme = plan.scheme,
            .scheme_word = std::string(facts_of(plan.scheme).word),
            .scheme_reason = open ? choose_scheme(world, facts).reason : "",
            .stable_step = stable_step(world, plan.scheme),
            .warnings = step_warnings(world, plan),
            .vertices = facts.cloth_vertices,
            .pinned_vertices = facts.pinned_vertices,
            .springs = facts.springs,
            .obstacles = facts.obstacles,
            .obstacle_triangles = facts.obstacle_triangles,
            .skipped = skipped_by(plan, world.settings, facts),
            .memory_bytes = predicted_memory(plan, facts),
            .evaluations_a_step = predicted_evaluations(plan, world.settings)};
}

}  // namespace percale
