#include "span_ledger.h"

#include <array>
#include <span>

#include "explicit_span.h"
#include "forces/spring_loss.h"
#include "schemes/schemes.h"
#include "scripted_motion.h"
#include "shape_loss.h"

namespace percale {
namespace {

/// An explicit scheme's stages: weights b and how far each is ahead of the last one's slopes, in steps.
struct Tableau {
    std::span<const double> weights, ahead;
};

constexpr double one[] = {1.0}, midpoint_weights[] = {0.0, 1.0}, midpoint_ahead[] = {0.5};
constexpr double rk4_weights[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0}, rk4_ahead[] = {0.5, 0.5, 1.0};

Tableau tableau_of(Scheme scheme) {
    if (scheme == Scheme::rk4) return {rk4_weights, rk4_ahead};
    if (scheme == Scheme::midpoint) return {midpoint_weights, midpoint_ahead};
    return {one, {}};
}

/// Of the air, as world.wind has it, on cloth that moves over the span while the drag stays what these velocities make it, J.
double wind_work(World& world, const LedgerSpan& span, const Vectors& velocities) {
    if (!world.plan.wind) return 0.0;
    Vectors& drag = world.ledger.forces;
    drag.resize(world.model.vertex_count());
    add_wind(world.model, world.wind, velocities, span.dt, drag, world.explicit_space.forces.wind);
    return sum_terms(0, world.model.vertex_count(),
                     [&](int i) { return drag.at(i).dot(world.state.positions.at(i) - span.positions.at(i)); });
}

/// The stage after the one whose forces were evaluated last.
void advance_stage(World& world, const LedgerSpan& span, double ahead) {
    ClothState& stage = world.ledger.stage;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        const Vec3 velocity = stage.velocities.at(i);
        stage.positions.set(i, span.positions.at(i) + ahead * span.dt * velocity);
        if (world.script.free[i] == 0.0) continue;
        const Vec3 acceleration = world.explicit_space.forces.total.at(i) / world.model.mass[i];
        stage.velocities.set(i, span.velocities.at(i) + ahead * span.dt * acceleration);
    }
}

/// Where an implicit scheme took forces, in the order of stage_weights.
std::array<ForcePlace, 3> stage_places(const World& world, const LedgerSpan& span) {
    const NewtonPoint& end = world.newton.current;
    const Vectors &middle = world.newton.start_positions, &middle_velocities = world.newton.start_velocities;
    return {{{span.positions, span.velocities, span.positions},
             {middle, middle_velocities, span.positions},
             {end.positions, end.velocities, middle}}};
}

/// The forces that an implicit scheme weighed.
void take_stages(World& world, const LedgerSpan& span) {
    const std::array<ForcePlace, 3> places = stage_places(world, span);
    const std::array<StageWeight, 3> weights = stage_weights(world.plan.scheme);
    begin_span(world);
    for (std::size_t stage = 0; stage < places.size(); ++stage) {
        if (weights[stage].share == 0.0) continue;
        set_seams_at(world, weights[stage].place);
        take_forces(world, span, weights[stage].share, places[stage]);
    }
    set_seams_at(world, 1.0);
}

/// sum w . r with the residual r of the last stage, J.
double residual_work(const World& world, const LedgerSpan& span) {
    return sum_terms(0, world.model.vertex_count(), [&](int i) {
        const Vec3 mean = (world.state.positions.at(i) - span.positions.at(i)) / span.dt;
        return mean.dot(world.newton.current.residual.at(i));
    });
}

}  // namespace

void begin_span(World& world) { world.ledger.impulse.resize(world.model.vertex_count()); }

void take_forces(World& world, const LedgerSpan& span, double weight, const ForcePlace& place) {
    const auto& [positions, velocities, air] = place;
    const SpringLoss loss = spring_loss(world.model.springs, {.start = span.positions,
                                                              .end = world.state.positions,
                                                              .positions = positions,
                                                              .velocities = velocities,
                                                              .form = DampingForm::velocity,
                                                              .dt = span.dt});
    world.report.energy.dissipated_material += weight * loss.material;
    const double shapes = shape_loss(world, {span.positions, world.state.positions, positions});
    world.report.energy.dissipated_integrator += weight * (loss.integrator + shapes);
    evaluate_at(world, place);
    world.report.energy.dissipated_integrator -= weight * wind_work(world, span, velocities);
    add_scaled(world.ledger.impulse, weight * span.dt, world.explicit_space.forces.total);
}

Unbalanced account_span(World& world, const LedgerSpan& span) {
    Unbalanced unbalanced;
    double kinetic = 0.0;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        const Vec3 before = span.velocities.at(i), after = world.state.velocities.at(i);
        const Vec3 mean = (world.state.positions.at(i) - span.positions.at(i)) / span.dt;
        const Vec3 momentum = world.model.mass[i] * (after - before);
        kinetic += (mean - 0.5 * (before + after)).dot(momentum);
        const double missing = mean.dot(momentum - world.ledger.impulse.at(i));
        (world.script.free[i] > 0.0 ? unbalanced.free : unbalanced.prescribed) += missing;
    }
    world.report.energy.dissipated_integrator += kinetic - unbalanced.prescribed;
    return unbalanced;
}

void account_explicit(World& world, const LedgerSpan& span) {
    ClothState& stage = world.ledger.stage;
    stage.positions = span.positions;
    stage.velocities = span.velocities;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] == 0.0) stage.velocities.set(i, world.state.velocities.at(i));
    }
    const Tableau tableau = tableau_of(world.plan.scheme);
    begin_span(world);
    for (std::size_t s = 0; s < tableau.weights.size(); ++s) {
        take_forces(world, span, tableau.weights[s], {stage.positions, stage.velocities, stage.positions});
        if (s < tableau.ahead.size()) advance_stage(world, span, tableau.ahead[s]);
    }
    account_span(world, span);
}

double stage_wind_work(World& world, const LedgerSpan& span) {
    if (!world.plan.wind || !world.plan.measures) return 0.0;
    const std::array<ForcePlace, 3> places = stage_places(world, span);
    const std::array<StageWeight, 3> weights = stage_weights(world.plan.scheme);
    double work = 0.0;
    for (std::size_t stage = 0; stage < places.size(); ++stage) {
        if (weights[stage].share == 0.0) continue;
        set_wind_at(world, places[stage].air);
        work += weights[stage].share * wind_work(world, span, places[stage].velocities);
    }
    return work;
}

void account_stages(World& world, const LedgerSpan& span, double work) {
    take_stages(world, span);
    const Unbalanced unbalanced = account_span(world, span);
    StepEnergy& energy = world.report.energy;
    const double residual = residual_work(world, span), obstacles = world.stages.obstacle_work;
    energy.dissipated_integrator += work - obstacles;
    if (world.plan.contacts) {
        const ContactTerms& contact = world.newton.current.forces.contact;
        const double end = contact.energy + grip_energy(contact.touches);
        energy.residual_work += residual;
        energy.dissipated_contact += world.ledger.contact - end - (unbalanced.free - residual) + obstacles;
        world.ledger.contact = end;
    } else if (world.plan.scheme == Scheme::bdf2) {
        energy.residual_work += residual;
        energy.dissipated_integrator -= unbalanced.free - residual;
    } else {
        energy.residual_work += unbalanced.free;
    }
}

}  // namespace percale
