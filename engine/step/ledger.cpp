#include "ledger.h"

#include "forces/contact_loss.h"
#include "forces/spring_loss.h"

namespace percale {
namespace {

/// 1/2 |v - v_n|_M^2, J.
double velocity_loss(const World& world, const Vectors& start, const Vectors& end) {
    return 0.5 *
           sum_terms(0, world.model.vertex_count(), [&](int i) { return world.model.mass[i] * square_between(end, start, i); });
}

ContactMove contact_move(const World& world, double dt) {
    const NewtonSpace& newton = world.newton;
    return {.rows = newton.current.forces.rows,
            .terms = newton.current.forces.contact,
            .start = newton.start_positions,
            .end = newton.current.positions,
            .dt = dt,
            .obstacle_rate = 1.0 / world.settings.time_step};
}

void account_penalty(World& world, const ContactMove& move) {
    StepEnergy& energy = world.report.energy;
    const ContactLoss loss = contact_loss(move);
    energy.dissipated_friction += loss.friction;
    energy.dissipated_integrator += loss.integrator;
    energy.dissipated_contact += world.ledger.contact - loss.stored_at_start;
}

/// A row's push is a constraint's: what it takes from motion towards the obstacle is gone.
void account_projection(World& world, const ContactMove& move) {
    StepEnergy& energy = world.report.energy;
    for (std::size_t row = 0; row < move.rows.size(); ++row) {
        const RowForce& force = world.newton.current.row_forces[row];
        const Vec3 moved = relative_move(move, row);
        energy.dissipated_contact -= force.normal * move.rows.direction[row].dot(moved);
        energy.dissipated_friction -= force.friction.dot(moved);
    }
    energy.dissipated_contact += world.ledger.contact - move.terms.energy;
}

void account_contact(World& world, double dt) {
    const ContactMove move = contact_move(world, dt);
    if (world.settings.contact_response == ContactResponse::projection) {
        account_projection(world, move);
    } else {
        account_penalty(world, move);
    }
    world.ledger.contact = move.terms.energy + grip_energy(move.terms.touches);
}

void account_symplectic_euler(World& world) {
    LedgerSpace& space = world.ledger;
    space.velocities = world.before.velocities;
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] == 0.0) space.velocities.set(i, world.state.velocities.at(i));
    }
    const SpringLoss loss = spring_loss(world.model.springs, {.start = world.before.positions,
                                                              .end = world.state.positions,
                                                              .positions = world.before.positions,
                                                              .velocities = space.velocities,
                                                              .form = DampingForm::velocity,
                                                              .dt = world.settings.time_step});
    StepEnergy& energy = world.report.energy;
    energy.dissipated_material += loss.material;
    energy.dissipated_integrator += loss.integrator + velocity_loss(world, world.before.velocities, world.state.velocities);
}

/// Positions and velocities in the middle of the step by the cubic through both ends (Hermite).
void set_middle(const World& world, Vectors& positions, Vectors& velocities) {
    const double dt = world.settings.time_step;
    const ClothState &start = world.before, &end = world.state;
    positions.resize(world.model.vertex_count());
    velocities.resize(world.model.vertex_count());
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        const Vec3 x0 = start.positions.at(i), x1 = end.positions.at(i), v0 = start.velocities.at(i), v1 = end.velocities.at(i);
        positions.set(i, 0.5 * (x0 + x1) + dt / 8.0 * (v0 - v1));
        velocities.set(i, 1.5 / dt * (x1 - x0) - 0.25 * (v0 + v1));
    }
}

double simpson(const World& world, LedgerSpace& space) {
    const SpringNetwork& springs = world.model.springs;
    set_middle(world, space.positions, space.velocities);
    const double power = damping_power(springs, world.before.positions, world.before.velocities) +
                         4.0 * damping_power(springs, space.positions, space.velocities) +
                         damping_power(springs, world.state.positions, world.state.velocities);
    return world.settings.time_step / 6.0 * power;
}

}  // namespace

void account_part(World& world, double dt) {
    const NewtonSpace& newton = world.newton;
    const NewtonPoint& end = newton.current;
    const SpringLoss springs = spring_loss(world.model.springs, {.start = newton.start_positions,
                                                                 .end = end.positions,
                                                                 .positions = end.positions,
                                                                 .velocities = end.velocities,
                                                                 .form = world.plan.damping,
                                                                 .dt = dt});
    StepEnergy& energy = world.report.energy;
    energy.dissipated_material += springs.material;
    energy.dissipated_integrator += springs.integrator + velocity_loss(world, newton.start_velocities, end.velocities);
    energy.residual_work += dot(world.compute, end.residual, end.velocities);
    if (world.plan.contacts) account_contact(world, dt);
}

void account_explicit(World& world) {
    if (world.settings.scheme == Scheme::symplectic_euler) return account_symplectic_euler(world);
    world.report.energy.dissipated_material += simpson(world, world.ledger);
}

void close_ledger(World& world, const StepEnergy& start) {
    StepEnergy& end = world.report.energy;
    end.imbalance = end.total() - start.total() + end.dissipated() - end.residual_work - end.work;
}

}  // namespace percale
