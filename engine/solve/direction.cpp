#include "direction.h"

#include <algorithm>

#include "support/stage_timer.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Fraction of its momentum that a linear solve with contact may leave in a body that nothing holds. Larger: sheets that slide
/// tremble, and friction between cloths is too large. Smaller: more linear iterations.
constexpr double net_momentum_ratio = 0.05;

void set_prescribed(const StageEquations& equations, Vec3Arrays& direction) {
    const ImplicitStage& stage = equations.stage();
    set_zero(stage.scene.compute, direction, stage.scene.model.vertex_count());
    if (!stage.scene.plan.pins_move || equations.arrived()) return;
    const Vec3Arrays& positions = equations.space().current.positions;
    for (int i = 0; i < stage.scene.model.vertex_count(); ++i) {
        if (!stage.scene.is_free(i)) direction.set(i, (stage.targets.at(i) - positions.at(i)) / stage.base.h);
    }
}

/// M dv = -r
void divide_by_mass(const StepScene& scene, const Vec3Arrays& residual, Vec3Arrays& direction) {
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) direction.set(i, -residual.at(i) / scene.model.mass[i]);
    }
}

/// Keeps settled bodies where they are: their part of the solution is 0, and the solver keeps it.
void leave_settled(const ClothModel& model, NewtonSpace& space) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        if (!space.bodies.settled(b)) continue;
        const Body& body = model.bodies[b];
        for (int i = body.first; i < body.first + body.count; ++i) space.right_side.set(i, Vec3::Zero());
    }
}

void fill_system(const StageEquations& equations, const TrialContacts* trial_contacts) {
    const ImplicitStage& stage = equations.stage();
    NewtonSpace& space = equations.space();
    const StagePoint& point = space.current;
    StageTimer timer(equations.times().setup);
    space.solver.fill(point.forces.spring_terms, trial_contacts ? trial_contacts->blocks : point.contact.blocks,
                      point.forces.blocks);
    set_each(stage.scene.compute, point.residual, point.residual, space.right_side, [](double r, double) { return 0.0 - r; });
    if (trial_contacts) trial_contacts->add_to(stage.scene.script.free, space.right_side);
    leave_settled(stage.scene.model, space);
    if (!stage.scene.plan.obstacles_move || equations.arrived()) return;
    const double rate = (stage.substep.to - point.fraction) / stage.base.h;
    add_obstacle_advance(point.constraints, point.contact, rate, stage.scene.script.free, space.right_side);
}

/// Where the translation of a body is not known, stiff constraints hide it from the energy norm. Its unbalanced momentum is
/// bounded by a fraction of the momentum from the right side or gravity, or by one whose motion is negligible (change_is_small).
void set_net_limits(const StepScene& scene, double dt, NewtonSpace& space) {
    space.net_limits.clear();
    space.rigid_modes.for_each_open(scene.model, [&](const Body& body) {
        Vec3 sum = Vec3::Zero();
        for (int i = body.first; i < body.first + body.count; ++i) sum += space.right_side.at(i);
        const double negligible = contact_accuracy * scene.model.thickness[body.first] / dt;  // m/s
        const double given = std::max(sum.norm(), body.mass * std::max(dt * scene.settings.gravity.norm(), negligible));
        space.net_limits.push_back({body.first, body.count, net_momentum_ratio * given});
    });
}

}  // namespace

Direction newton_direction(const StageEquations& equations, const SolveTarget& target, const TrialContacts* trial_contacts) {
    const ImplicitStage& stage = equations.stage();
    NewtonSpace& space = equations.space();
    const StagePoint& point = space.current;
    set_prescribed(equations, space.direction);
    if (!stage.options.jacobians) {
        divide_by_mass(stage.scene, point.residual, space.direction);
        return {};
    }
    fill_system(equations, trial_contacts);
    StageTimer timer(equations.times().solve);
    const ClothModel& model = stage.scene.model;
    space.rigid_modes.find(stage.scene, space.bodies, space.solver.matrix.coupled, point.forces.blocks.outer);
    // The correction comes before the solve, too: only the deformation is then left to be solved, with its accuracy.
    space.rigid_modes.correct(model, point.residual, space.direction);
    set_net_limits(stage.scene, stage.base.h, space);
    SolveTarget wanted = target;
    wanted.net = space.net_limits;
    const SolveReport solved = space.solver.solve(space.right_side, wanted, space.direction);
    space.rigid_modes.correct(model, point.residual, space.direction);
    return {solved.iterations, solved.converged};
}

bool estimate_direction(const StageEquations& equations) {
    NewtonSpace& space = equations.space();
    StageTimer timer(equations.times().solve);
    if (!space.solver.estimate(space.current.residual, space.direction)) return false;
    set_each(equations.stage().scene.compute, space.direction, space.direction, space.direction,
             [](double z, double) { return -z; });  // the direction is -A^-1 r
    return true;
}

}  // namespace percale
