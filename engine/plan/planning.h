#pragma once

#include "step/world.h"

namespace percale {

/// What a plan is made from: counts, fabrics, and the motion that the script holds now together with `to_come`.
SceneFacts scene_facts(const World& world, const ScriptedChanges& to_come = {});

/// Makes the plan anew if the scene has changed since; then enters what moves in the coming step.
void update_plan(World& world);

/// The plan of a scene that has not changed since it was made; of the known one only what `automatic` chose and what moves in
/// its step is taken over.
StepPlan plan_again(const World& world, const StepPlan& known);

/// The scene has changed: the plan is made anew by the next step, and cloth at rest wakes up.
void scene_changed(World& world);

/// The plan with its skips and predicted costs.
ScenePlan scene_plan(const World& world, const ScriptedChanges& to_come);

}  // namespace percale
