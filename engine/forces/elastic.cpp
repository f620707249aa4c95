#include "elastic.h"

#include <algorithm>

#include "spring_loss.h"
#include "springs.h"

namespace percale {
namespace {

bool is_elastic(const ForceTerm& term, const ClothModel& model) {
    return term.entry() == &StepEnergy::elastic && term.acts({.model = &model});
}

void evaluate_at(const Compute& compute, const ClothModel& model, const Vec3Arrays& positions,
                 std::span<const double> rest_length, ElasticSpace& space) {
    constexpr double any_dt = 1.0;  // s: forces without damping and matrix do not depend on it
    space.still.resize(model.vertex_count());
    set_step_springs(compute, {model.adjacency, positions, DampingForm::velocity, any_dt, rest_length, &model.springs},
                     space.springs);
    evaluate_forces({.compute = &compute,
                     .model = &model,
                     .springs = &space.springs,
                     .positions = &positions,
                     .velocities = &space.still,
                     .dt = any_dt},
                    space.forces);
}

}  // namespace

void evaluate_elastic(const Compute& compute, const ClothModel& model, const ClothState& state, ElasticSpace& space) {
    evaluate_at(compute, model, state.positions, state.rest_length, space);
}

bool has_shapes(const ClothModel& model) {
    return std::ranges::any_of(force_terms(),
                               [&](const ForceTerm* term) { return term != &spring_term() && is_elastic(*term, model); });
}

double elastic_energy(const ClothModel& model, const Vec3Arrays& positions, std::span<const double> rest_length) {
    double energy = 0.0;
    for (const ForceTerm* term : force_terms()) {
        if (is_elastic(*term, model)) energy += term->energy({model, positions, rest_length});
    }
    return energy;
}

double shape_loss(const Compute& compute, const ClothModel& model, const ShapeMove& move, ElasticSpace& space) {
    if (!has_shapes(model)) return 0.0;
    evaluate_at(compute, model, move.positions, move.rest_length, space);
    const Vec3Arrays& force = space.forces.total;
    const double taken =
        sum_terms(0, model.vertex_count(), [&](int i) { return -force.at(i).dot(move.end.at(i) - move.start.at(i)); });
    const SpringLoss springs = spring_loss(model.springs, {.start = move.start,
                                                           .end = move.end,
                                                           .positions = move.positions,
                                                           .velocities = space.still,
                                                           .form = DampingForm::velocity,
                                                           .dt = 1.0,
                                                           .rest_length = move.rest_length});
    const auto energy = [&](const Vec3Arrays& positions) { return elastic_energy(model, positions, move.rest_length); };
    return taken - (energy(move.end) - energy(move.start)) - springs.integrator;
}

}  // namespace percale
