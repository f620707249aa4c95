#include "planning.h"

#include <algorithm>
#include <string>
#include <utility>

#include "forces/hinge_bending.h"
#include "plan_costs.h"
#include "scheme_choice.h"
#include "schemes/schemes.h"

namespace percale {
namespace {

bool pins_move(const StepScene& scene, const ClothState& state) {
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (!scene.is_free(i) && scene.script.pin_targets.at(i) != state.positions.at(i)) return true;
    }
    return false;
}

bool obstacles_move(const StepScene& scene) {
    return std::any_of(scene.script.obstacles.begin(), scene.script.obstacles.end(),
                       [](const ObstacleState& obstacle) { return obstacle.moves(); });
}

bool seams_close(const StepScene& scene, double time) {
    return std::any_of(scene.script.seams.begin(), scene.script.seams.end(),
                       [&](const Seam& seam) { return seam.closes_after(time - scene.settings.time_step); });
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

/// All facts except the choices of `automatic`.
SceneFacts counted_facts(const StepScene& scene, const ClothState& state, const ScriptedChanges& to_come) {
    const ClothModel& model = scene.model;
    SceneFacts facts;
    facts.cloth_vertices = model.vertex_count();
    for (int i = 0; i < facts.cloth_vertices; ++i) facts.pinned_vertices += scene.script.free[i] == 0.0;
    facts.cloth_triangles = static_cast<int>(model.triangles.size());
    facts.springs = count_springs(model.springs);
    facts.springs.triangle = static_cast<int>(model.membrane.size());
    facts.damped = std::any_of(model.springs.damping.begin(), model.springs.damping.end(), [](double kd) { return kd > 0.0; });
    facts.obstacles = static_cast<int>(scene.script.obstacles.size());
    for (const ObstacleState& obstacle : scene.script.obstacles) facts.obstacle_triangles += obstacle.triangles;
    facts.detector = scene.detector != nullptr;
    facts.changes = to_come;
    facts.changes.obstacles = to_come.obstacles || obstacles_move(scene);
    facts.changes.pins = to_come.pins || pins_move(scene, state);
    facts.springs.hinge = static_cast<int>(model.hinges.all.size());
    facts.pairs = scene.script.pairs;
    for (const ClothRange& cloth : model.cloths) facts.cloths.push_back({cloth.name, cloth.grid, cloth.fabric});
    return facts;
}

/// Chooses a scheme and returns the reason; empty where the settings leave no choice.
std::string choose(const StepScene& scene, const ClothState& state, SceneFacts& facts) {
    if (scene.settings.scheme != Scheme::automatic) return "";
    SchemeChoice choice = choose_scheme(scene, state, facts);
    facts.chosen = choice.scheme;
    facts.parts = choice.parts;
    return std::move(choice.reason);
}

}  // namespace

SceneFacts scene_facts(const StepScene& scene, const ClothState& state, const ScriptedChanges& to_come) {
    SceneFacts facts = counted_facts(scene, state, to_come);
    choose(scene, state, facts);
    return facts;
}

double renew_plan(StepScene& scene, const ClothState& state) {
    scene.plan = make_step_plan(scene.settings, scene_facts(scene, state));
    if (!scene.plan.hinges) return 0.0;
    const double before = hinge_energy(scene.model.hinges, state.positions);
    set_model_clamps(scene.script.free, scene.model);
    return hinge_energy(scene.model.hinges, state.positions) - before;
}

void set_motion_of_step(StepScene& scene, const ClothState& state, double time) {
    ScriptedChanges now;
    now.obstacles = obstacles_move(scene);
    now.pins = scene.plan.pins && pins_move(scene, state);
    set_motion(scene.plan, now);
    scene.plan.seams_close = seams_close(scene, time);
}

StepPlan plan_again(const StepScene& scene, const ClothState& state, const StepPlan& known) {
    SceneFacts facts = counted_facts(scene, state, {});
    facts.chosen = known.scheme;
    facts.parts = known.parts;
    StepPlan plan = make_step_plan(scene.settings, facts);
    set_motion(plan, {.obstacles = known.obstacles_move, .pins = known.pins_move});
    plan.seams_close = known.seams_close;
    return plan;
}

ScenePlan scene_plan(const StepScene& scene, const ClothState& state, const ScriptedChanges& to_come) {
    SceneFacts facts = counted_facts(scene, state, to_come);
    std::string reason = choose(scene, state, facts);
    const StepPlan plan = make_step_plan(scene.settings, facts);
    const double stable = stable_step(scene, state, plan.scheme);
    return {.scheme = plan.scheme,
            .scheme_word = std::string(facts_of(plan.scheme).word),
            .scheme_reason = std::move(reason),
            .stable_step = stable,
            .warnings = step_warnings(scene, state, plan, stable),
            .vertices = facts.cloth_vertices,
            .pinned_vertices = facts.pinned_vertices,
            .springs = facts.springs,
            .obstacles = facts.obstacles,
            .obstacle_triangles = facts.obstacle_triangles,
            .skipped = skipped_by(plan, scene.settings, facts),
            .memory_bytes = predicted_memory(plan, facts),
            .evaluations_a_step = predicted_evaluations(plan, scene.settings)};
}

}  // namespace percale
