#include "planning.h"

#include <algorithm>

#include "model/plan_costs.h"
#include "rest_detection.h"

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

SpringCounts count_springs(const SpringNetwork& springs) {
    SpringCounts counts;
    for (const SpringKind kind : springs.kind) {
        if (kind == SpringKind::structural) ++counts.structural;
        if (kind == SpringKind::shear) ++counts.shear;
        if (kind == SpringKind::bend) ++counts.bend;
    }
    return counts;
}

}  // namespace

SceneFacts scene_facts(const World& world, const ScriptedChanges& to_come) {
    const ClothModel& model = world.model;
    SceneFacts facts;
    facts.cloth_vertices = model.vertex_count();
    for (int i = 0; i < facts.cloth_vertices; ++i) facts.pinned_vertices += world.script.free[i] == 0.0;
    facts.cloth_triangles = static_cast<int>(model.triangles.size());
    facts.springs = count_springs(model.springs);
    facts.damped = std::any_of(model.springs.damping.begin(), model.springs.damping.end(), [](double kd) { return kd > 0.0; });
    facts.obstacles = static_cast<int>(world.script.obstacles.size());
    for (const ObstacleState& obstacle : world.script.obstacles) facts.obstacle_triangles += obstacle.triangles;
    facts.detector = world.detector != nullptr;
    facts.changes = to_come;
    facts.changes.obstacles = to_come.obstacles || obstacles_move(world);
    facts.changes.pins = to_come.pins || pins_move(world);
    for (const ClothRange& cloth : model.cloths) facts.cloths.push_back({cloth.name, cloth.grid, cloth.fabric});
    return facts;
}

void update_plan(World& world) {
    if (world.plan_outdated) world.plan = make_step_plan(world.settings, scene_facts(world));
    world.plan_outdated = false;
    ScriptedChanges now;
    now.obstacles = obstacles_move(world);
    now.pins = world.plan.pins && pins_move(world);
    set_motion(world.plan, now);
}

void scene_changed(World& world) {
    world.plan_outdated = true;
    world.stages.earlier_length = 0.0;
    wake(world.rest);
}

ScenePlan scene_plan(const World& world, const ScriptedChanges& to_come) {
    const SceneFacts facts = scene_facts(world, to_come);
    const StepPlan plan = make_step_plan(world.settings, facts);
    return {.scheme = plan.scheme,
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
