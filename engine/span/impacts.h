#pragma once

#include "plan/scene.h"
#include "solve/implicit_stage.h"

namespace percale {

/// What contact gives a cloth in a stage of the trapezoid is twice what stops it there. A point that is pressed leaves no faster
/// than it went in the mean of the stage, and not at all if it came nearer. `contacts`: the end of the stage of `length` s, which
/// began at `start`, m; changes the velocities of `end`. `order` is memory.
struct StageMove {
    const StagePoint& contacts;
    const Vectors& start;
    double length;
};
void settle_impacts(const StepScene& scene, const StageMove& move, ClothState& end, std::vector<std::size_t>& order);

}  // namespace percale
