#include "direction.h"

#include <algorithm>

#include "support/stage_timer.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Fraction of its momentum that a linear solve with contact may leave in a body that nothing holds. Larger: sheets that slide
/// tremble, and friction between cloths is too large. Smaller: more linear iterations.
constexpr double net_momentum_ratio = 0.05;

void set_prescribed(const StageEquations& equations, const StagePoint& point, Vec3Arrays& direction) {
    const ImplicitStage& stage = equations.stage();
    set_zero(stage.scene.compute, direction, stage.scene.model.vertex_count());
    if (!stage.scene.plan.pins_move || equations.arrived(point)) return;
    for (int i = 0; i < stage.scene.model.vertex_count(); ++i) {
        if (!stage.scene.is_free(i)) direction.set(i, (stage.targets.at(i) - point.positions.at(i)) / stage.base.h);
    }
}

/// M dv = -r
void divide_by_mass(const StepScene& scene, const Vec3Arrays& residual, Vec3Arrays& direction) {
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) direction.set(i, -residual.at(i) / scene.model.mass[i]);
    }
}

/// Keeps settled bodies where they are: their part of the solution is 0, and the solver keeps it.
void leave_settled(const ClothModel& model, const BodyStates& bodies, Vec3Arrays& right_side) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        if (!bodies.settled(b)) continue;
        const Body& body = model.bodies[b];
        for (int i = body.first; i < body.first + body.count; ++i) right_side.set(i, Vec3::Zero());
    }
}

}  // namespace

void NewtonSystem::begin_stage(const ImplicitStage& stage) {
    const StepScene& scene = stage.scene;
    if (!solver.is_for(scene.model)) solver.set_model(scene.compute, scene.model, scene.settings.linear_solver);
    solver.matrix.free = scene.script.free;
    solver.start_stage();
    set_zero(scene.compute, right_side, scene.model.vertex_count());
}

void NewtonSystem::fill(const StageEquations& equations, const StagePoint& point, const DirectionTask& task) {
    const ImplicitStage& stage = equations.stage();
    StageTimer timer(equations.times().setup);
    solver.fill(point.forces.spring_terms, point.contact.blocks, point.forces.blocks);
    set_each(stage.scene.compute, point.residual, point.residual, right_side, [](double r, double) { return 0.0 - r; });
    leave_settled(stage.scene.model, task.bodies, right_side);
    if (!stage.scene.plan.obstacles_move || equations.arrived(point)) return;
    const double rate = (stage.substep.to - point.fraction) / stage.base.h;
    add_obstacle_advance(point.constraints, point.contact, rate, stage.scene.script.free, right_side);
}

/// Where the translation of a body is not known, stiff constraints hide it from the energy norm. Its unbalanced momentum is
/// bounded by a fraction of the momentum from the right side or gravity, or by one whose motion is negligible (change_is_small).
void NewtonSystem::set_net_limits(const StepScene& scene, double dt) {
    net_limits.clear();
    rigid_modes.for_each_open(scene.model, [&](const Body& body) {
        Vec3 sum = Vec3::Zero();
        for (int i = body.first; i < body.first + body.count; ++i) sum += right_side.at(i);
        const double negligible = contact_accuracy * scene.model.thickness[body.first] / dt;  // m/s
        const double given = std::max(sum.norm(), body.mass * std::max(dt * scene.settings.gravity.norm(), negligible));
        net_limits.push_back({body.first, body.count, net_momentum_ratio * given});
    });
}

void NewtonSystem::find_direction(const StageEquations& equations, const StagePoint& point, const DirectionTask& task,
                                  Direction& found) {
    const ImplicitStage& stage = equations.stage();
    set_prescribed(equations, point, found.velocity);
    found.linear_iterations = 0;
    found.exact = true;
    if (!stage.options.jacobians) return divide_by_mass(stage.scene, point.residual, found.velocity);
    fill(equations, point, task);
    StageTimer timer(equations.times().solve);
    const ClothModel& model = stage.scene.model;
    rigid_modes.find(stage.scene, task.bodies, solver.matrix.coupled, point.forces.blocks.outer);
    // The correction comes before the solve, too: only the deformation is then left to be solved, with its accuracy.
    rigid_modes.correct(model, point.residual, found.velocity);
    set_net_limits(stage.scene, stage.base.h);
    SolveTarget wanted = task.target;
    wanted.net = net_limits;
    const SolveReport solved = solver.solve(right_side, wanted, found.velocity);
    rigid_modes.correct(model, point.residual, found.velocity);
    found.linear_iterations = solved.iterations;
    found.exact = solved.converged;
}

bool NewtonSystem::estimate_direction(const StageEquations& equations, const StagePoint& point, Direction& found) {
    StageTimer timer(equations.times().solve);
    if (!solver.estimate(point.residual, found.velocity)) return false;
    set_each(equations.stage().scene.compute, found.velocity, found.velocity, found.velocity,
             [](double z, double) { return -z; });  // the direction is -A^-1 r
    return true;
}

}  // namespace percale
