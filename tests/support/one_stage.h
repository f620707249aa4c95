#pragma once

#include <utility>

#include "engine/solve/newton.h"
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

/// The search of a stage, at its first point.
struct StageSearch {
    NewtonSpace& space;
    StageEquations equations;

    StageSearch(const ImplicitStage& stage, const ContactWarmStart& warm_start, SolverScene& scene)
        : space(scene.newton), equations(begun(stage, warm_start, scene)) {
        equations.begin(space.current, space.trial, space.direction.velocity);
    }
    void evaluate() { equations.evaluate(space.current, nullptr); }
    /// space.trial = current + factor * direction, with its forces.
    void go(double factor) {
        equations.move(space.current, space.direction.velocity, factor, space.trial);
        equations.evaluate(space.trial, &space.current);
    }

private:
    static StageEquations begun(const ImplicitStage& stage, const ContactWarmStart& warm_start, SolverScene& scene) {
        NewtonSpace& space = scene.newton;
        space.system.begin_stage(stage);
        return {stage, warm_start, space.stage, space.system.solver.matrix, scene.stages};
    }
};

}  // namespace percale::test
