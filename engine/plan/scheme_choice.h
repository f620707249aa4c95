#pragma once

#include <string>
#include <vector>

#include "percale/plan.h"
#include "scene.h"

namespace percale {

/// Estimated longest stable step of a scheme for the cloth as it is now, s: that of an oscillator with the springs' largest
/// angular frequency and largest damping (percale/stability.h). Infinity for schemes that are always stable, 0 for those that
/// amplify undamped motion.
double stable_step(const StepScene& scene, const ClothState& state, Scheme scheme);

/// The scheme that Scheme::automatic selects, and the reason.
struct SchemeChoice {
    Scheme scheme = Scheme::backward_euler;
    int parts = 1;  // equal parts into which an explicit scheme divides a step
    std::string reason = {};
};

/// Without contact the explicit scheme if all its short steps cost less than one implicit step by the fixed cost model
/// (plan_costs.h): symplectic_euler against backward_euler; of adaptive steps rk4 against tr_bdf2. With
/// contact tr_bdf2 for adaptive steps, backward_euler otherwise and where contact is projected.
SchemeChoice choose_scheme(const StepScene& scene, const ClothState& state, const SceneFacts& facts);

/// Whether a scheme with that number of parts can make a step of this scene: by the settings, or by a choice of choose_scheme.
bool can_be_chosen(const StepScene& scene, Scheme scheme, int parts);

/// Warnings of settings that cause failure or inaccuracy; `stable`: stable_step of the plan's scheme.
std::vector<PlanWarning> step_warnings(const StepScene& scene, const ClothState& state, const StepPlan& plan, double stable);

}  // namespace percale
