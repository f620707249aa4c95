#include "shape_loss.h"

#include "forces/hinge_bending.h"
#include "forces/membrane_springs.h"
#include "forces/spring_loss.h"

namespace percale {

void evaluate_elastic(const World& world, const Vectors& positions, const Vectors& still, ExplicitSpace& space) {
    set_step_springs(world.compute, {world.model.adjacency, positions, DampingForm::velocity, world.settings.time_step},
                     space.springs);
    evaluate_forces({.compute = &world.compute,
                     .model = &world.model,
                     .springs = &space.springs,
                     .positions = &positions,
                     .velocities = &still,
                     .dt = world.settings.time_step},
                    space.forces);
}

double shape_energy(const ClothModel& model, const Vectors& positions) {
    double energy = elastic_energy(model.springs, positions);
    if (!model.hinges.all.empty()) energy += hinge_energy(model.hinges, positions);
    if (!model.membrane.empty()) energy += membrane_energy(model.membrane, positions);
    return energy;
}

double shape_loss(World& world, const ShapeMove& move) {
    const ClothModel& model = world.model;
    if (model.hinges.all.empty() && model.membrane.empty()) return 0.0;
    world.ledger.still.resize(model.vertex_count());
    evaluate_elastic(world, move.positions, world.ledger.still, world.explicit_space);
    const Vectors& force = world.explicit_space.forces.total;
    const double taken =
        sum_terms(0, model.vertex_count(), [&](int i) { return -force.at(i).dot(move.end.at(i) - move.start.at(i)); });
    const SpringLoss springs = spring_loss(model.springs, {.start = move.start,
                                                           .end = move.end,
                                                           .positions = move.positions,
                                                           .velocities = world.ledger.still,
                                                           .form = DampingForm::velocity,
                                                           .dt = world.settings.time_step});
    return taken - (shape_energy(model, move.end) - shape_energy(model, move.start)) - springs.integrator;
}

}  // namespace percale
