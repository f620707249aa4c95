#pragma once

#include <string>
#include <vector>

#include "scene.h"

namespace percale {

/// Estimated longest stable step of a scheme for the cloth as it is now, s: that of an oscillator with the springs' largest
/// angular frequency and largest damping (percale/stability.h). Infinity for schemes that are always stable, 0 for those that let
/// what is not damped grow.
double stable_step(const StepScene& scene, const ClothState& state, Scheme scheme);

/// What stands for Scheme::automatic, and why.
struct SchemeChoice {
    Scheme scheme = Scheme::backward_euler;
    int parts = 1;  // equal ones that a step of an explicit scheme is made in
    std::string reason = {};
};

/// Without contact the explicit scheme if all its short steps cost less than one implicit step by the fixed cost model
/// (plan_costs.h): symplectic_euler against backward_euler; of adaptive steps rk4 against tr_bdf2. With
/// contact tr_bdf2 for adaptive steps, backward_euler otherwise and where contact is projected.
SchemeChoice choose_scheme(const StepScene& scene, const ClothState& state, const SceneFacts& facts);

/// Whether a step of this scene can be made by a scheme in that many parts: as the settings say, or as choose_scheme might have
/// chosen.
bool can_be_chosen(const StepScene& scene, Scheme scheme, int parts);

/// What the settings will make go wrong or inexact, one sentence each; `stable`: stable_step of the plan's scheme.
std::vector<std::string> step_warnings(const StepScene& scene, const ClothState& state, const StepPlan& plan, double stable);

}  // namespace percale
