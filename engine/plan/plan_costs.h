#pragma once

#include "step_plan.h"

namespace percale {

/// Predicted memory of a simulation with its detector once steps run, bytes: an amount per vertex and per spring, and where
/// there is contact per triangle of cloth and obstacle (FCL's tree). The lists of near pairs come on top, as their number cannot
/// be predicted: some hundred bytes to some thousand a cloth triangle in contact.
double predicted_memory(const StepPlan& plan, const SceneFacts& facts);

/// Predicted cost of a step, in evaluations of all spring forces: those of an explicit scheme; else the usual number of Newton
/// and linear iterations, each at its fraction of an evaluation (counted instructions). Detection comes on top.
double predicted_evaluations(const StepPlan& plan, const StepSettings& settings);

}  // namespace percale
