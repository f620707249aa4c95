#pragma once

#include "scene.h"

namespace percale {

/// The facts that a plan is made from: counts, fabrics, and the motion that the script holds now together with `to_come`.
SceneFacts scene_facts(const StepScene& scene, const ClothState& state, const ScriptedChanges& to_come = {});

/// Makes the plan anew. Added and removed pins change the energy of hinges beside them: the change, J, is returned as the work
/// of their caller.
double renew_plan(StepScene& scene, const ClothState& state);

/// Enters what moves in the coming step, which begins at `time` s.
void set_motion_of_step(StepScene& scene, const ClothState& state, double time);

/// The plan of a scene that has not changed since it was made; it takes from the known plan only the choices of `automatic` and
/// what moves in its step.
StepPlan plan_again(const StepScene& scene, const ClothState& state, const StepPlan& known);

/// The plan with its skips and predicted costs.
ScenePlan scene_plan(const StepScene& scene, const ClothState& state, const ScriptedChanges& to_come);

}  // namespace percale
