#include "ledger.h"

#include "contact/contact_loss.h"
#include "forces/spring_loss.h"
#include "measure.h"
#include "shape_loss.h"
#include "span_ledger.h"

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

void account_backward_euler(World& world, double dt) {
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
    energy.dissipated_integrator += shape_loss(world, {newton.start_positions, end.positions, end.positions});
    energy.residual_work += dot(world.compute, end.residual, end.velocities);
    if (world.plan.contacts) account_contact(world, dt);
}

}  // namespace

void begin_ledger(World& world) {
    world.ledger.contact = world.contact_energy;
    world.ledger.start_energy = current_energy(world).total() - world.report.energy.work;
}

void account_implicit(World& world, double dt, double work) {
    if (world.plan.scheme == Scheme::backward_euler) return account_backward_euler(world, dt);
    account_stages(world, {world.stages.start.positions, world.stages.start.velocities, dt}, work);
}

void close_ledger(World& world) {
    StepEnergy& end = world.report.energy;
    end.imbalance = end.total() - world.ledger.start_energy + end.dissipated() - end.residual_work - end.work;
}

}  // namespace percale
