#include "direction.h"

#include <algorithm>

#include "support/stage_timer.h"
#include "tolerances.h"

namespace percale {
namespace {

void set_prescribed(const StageEquations& equations, Vectors& direction) {
    const ImplicitStage& stage = equations.stage();
    set_zero(stage.scene.compute, direction, stage.scene.model.vertex_count());
    if (!stage.scene.plan.pins_move || equations.arrived()) return;
    const Vectors& positions = equations.space().current.positions;
    for (int i = 0; i < stage.scene.model.vertex_count(); ++i) {
        if (!stage.scene.is_free(i)) direction.set(i, (stage.targets.at(i) - positions.at(i)) / stage.base.h);
    }
}

/// M dv = -r
void divide_by_mass(const StepScene& scene, const Vectors& residual, Vectors& direction) {
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) direction.set(i, -residual.at(i) / scene.model.mass[i]);
    }
}

/// Bodies that are settled stay where they are: 0 is their part of the solution, and the solver never leaves it.
void leave_settled(const ClothModel& model, NewtonSpace& space) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        if (!space.bodies.settled(b)) continue;
        const Body& body = model.bodies[b];
        for (int i = body.first; i < body.first + body.count; ++i) space.right_side.set(i, Vec3::Zero());
    }
}

void fill_system(const StageEquations& equations, const ForeseenRows* foreseen) {
    const ImplicitStage& stage = equations.stage();
    NewtonSpace& space = equations.space();
    const StagePoint& point = space.current;
    StageTimer timer(equations.times().setup);
    space.solver.fill(point.forces.spring_terms, foreseen ? foreseen->blocks : point.contact.blocks);
    space.solver.add_enclosed(point.forces.enclosed, point.positions);
    set_each(stage.scene.compute, point.residual, point.residual, space.right_side, [](double r, double) { return 0.0 - r; });
    if (foreseen) foreseen->add_to(stage.scene.script.free, space.right_side);
    leave_settled(stage.scene.model, space);
    if (!stage.scene.plan.obstacles_move || equations.arrived()) return;
    const double rate = (stage.span.to - point.fraction) / stage.base.h;
    add_obstacle_advance(point.rows, point.contact, rate, stage.scene.script.free, space.right_side);
}

/// Where it is not known how a body moves as a whole, stiff rows hide that from the energy: what is left of it is bounded, by a
/// share of the momentum that the right side or gravity gives, or that moves it by no more than means nothing (change_is_small).
void set_net_limits(const StepScene& scene, double dt, NewtonSpace& space) {
    space.net_limits.clear();
    space.translations.for_each_open(scene.model, [&](const Body& body) {
        Vec3 sum = Vec3::Zero();
        for (int i = body.first; i < body.first + body.count; ++i) sum += space.right_side.at(i);
        const double negligible = contact_accuracy * scene.model.thickness[body.first] / dt;  // m/s
        const double given = std::max(sum.norm(), body.mass * std::max(dt * scene.settings.gravity.norm(), negligible));
        space.net_limits.push_back({body.first, body.count, net_momentum_share * given});
    });
}

}  // namespace

Direction newton_direction(const StageEquations& equations, const SolveTarget& target, const ForeseenRows* foreseen) {
    const ImplicitStage& stage = equations.stage();
    NewtonSpace& space = equations.space();
    const StagePoint& point = space.current;
    set_prescribed(equations, space.direction);
    if (!stage.options.jacobians) {
        divide_by_mass(stage.scene, point.residual, space.direction);
        return {};
    }
    fill_system(equations, foreseen);
    StageTimer timer(equations.times().solve);
    const ClothModel& model = stage.scene.model;
    space.translations.find(stage.scene, space.bodies, foreseen ? foreseen->blocks : point.contact.blocks);
    // As the start, too: what is left to solve for, and to be exact about, is how the cloth deforms.
    space.translations.correct(model, point.residual, space.direction);
    set_net_limits(stage.scene, stage.base.h, space);
    SolveTarget wanted = target;
    wanted.net = space.net_limits;
    const SolveReport solved = space.solver.solve(space.right_side, wanted, space.direction);
    space.translations.correct(model, point.residual, space.direction);
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
