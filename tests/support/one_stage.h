#pragma once

#include <utility>

#include "engine/solve/stage_equations.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test {

/// One stage of backward Euler of a scene.
struct OneStage {
    SolverScene scene;
    ContactWarmStart warm_start;

    explicit OneStage(SolverScene of) : scene(std::move(of)) {
        scene.before = scene.state;
        set_euler_base(scene.before, scene.settings.time_step, scene.base);
    }
    ImplicitStage stage() const { return {.scene = scene, .base = scene.base, .start = scene.before, .targets = scene.targets}; }
};

}  // namespace percale::test
