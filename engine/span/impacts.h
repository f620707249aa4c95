#pragma once

#include "plan/scene.h"
#include "solve/implicit_stage.h"

namespace percale {

/// A stage that was just solved.
struct StageMove {
    const StagePoint& contacts;  // at its end
    const Vectors& start;        // m, where it began
    double length;               // s
};

/// What contact gives a cloth in a stage of the trapezoid is twice what stops it there. A point that is pressed leaves no faster
/// than it went in the mean of the stage, and not at all if it came nearer. Changes the velocities of `end`; `order` is memory.
void settle_impacts(const StepScene& scene, const StageMove& move, ClothState& end, std::vector<std::size_t>& order);

}  // namespace percale
