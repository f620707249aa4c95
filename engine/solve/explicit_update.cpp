#include "explicit_update.h"

namespace percale {
namespace {

/// space.forces at a state.
void evaluate(const ExplicitPart& part, const ClothState& state, ExplicitSpace& space) {
    const ForceInput input{.compute = part.compute,
                           .model = part.model,
                           .springs = &space.springs,
                           .positions = &state.positions,
                           .velocities = &state.velocities,
                           .gravity = part.settings->gravity,
                           .dt = part.dt,
                           .with_matrix = false};
    evaluate_forces(input, space.forces);
}

void start(const ExplicitPart& part, ExplicitSpace& space, const ClothState& state) {
    set_step_springs(*part.compute, {part.model->adjacency, state.positions, DampingForm::velocity, part.dt}, space.springs);
}

bool is_free(const ExplicitPart& part, int i) { return (*part.free)[i] > 0.0; }

/// space.acceleration = f/m at a state; 0 at prescribed vertices.
void accelerate(const ExplicitPart& part, const ClothState& state, ExplicitSpace& space) {
    evaluate(part, state, space);
    space.acceleration.resize(part.model->vertex_count());
    for (int i = 0; i < part.model->vertex_count(); ++i) {
        if (is_free(part, i)) space.acceleration.set(i, space.forces.total.at(i) / part.model->mass[i]);
    }
}

/// The velocity with which prescribed vertices reach their targets.
void set_prescribed_velocities(const ExplicitPart& part, ClothState& state) {
    for (int i = 0; i < part.model->vertex_count(); ++i) {
        if (is_free(part, i)) continue;
        state.velocities.set(i, (part.targets->at(i) - state.positions.at(i)) / part.dt);
    }
}

void finish(const ExplicitPart& part, ClothState& state) {
    for (int i = 0; i < part.model->vertex_count(); ++i) {
        if (!is_free(part, i)) state.positions.set(i, part.targets->at(i));
    }
    update_points(state);
}

void step_symplectic_euler(const ExplicitPart& part, ExplicitSpace& space, ClothState& state) {
    evaluate(part, state, space);
    for (int i = 0; i < part.model->vertex_count(); ++i) {
        if (!is_free(part, i)) continue;
        state.velocities.add(i, part.dt * space.forces.total.at(i) / part.model->mass[i]);
    }
    add_scaled(state.positions, part.dt, state.velocities);
}

void step_forward_euler(const ExplicitPart& part, ExplicitSpace& space, ClothState& state) {
    accelerate(part, state, space);
    add_scaled(state.positions, part.dt, state.velocities);
    add_scaled(state.velocities, part.dt, space.acceleration);
}

void step_midpoint(const ExplicitPart& part, ExplicitSpace& space, ClothState& state) {
    accelerate(part, state, space);
    space.stage.positions = state.positions;
    space.stage.velocities = state.velocities;
    add_scaled(space.stage.positions, 0.5 * part.dt, state.velocities);
    add_scaled(space.stage.velocities, 0.5 * part.dt, space.acceleration);
    accelerate(part, space.stage, space);
    add_scaled(state.positions, part.dt, space.stage.velocities);
    add_scaled(state.velocities, part.dt, space.acceleration);
}

void step_rk4(const ExplicitPart& part, ExplicitSpace& space, ClothState& state) {
    space.velocity_sum.resize(part.model->vertex_count());
    space.acceleration_sum.resize(part.model->vertex_count());
    space.stage = state;
    constexpr double weight[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    constexpr double ahead[] = {0.5, 0.5, 1.0};  // where the next stage is evaluated, in steps
    for (int s = 0; s < 4; ++s) {
        accelerate(part, space.stage, space);
        add_scaled(space.velocity_sum, weight[s], space.stage.velocities);
        add_scaled(space.acceleration_sum, weight[s], space.acceleration);
        if (s == 3) break;
        space.stage_velocities = space.stage.velocities;
        space.stage.positions = state.positions;
        space.stage.velocities = state.velocities;
        add_scaled(space.stage.positions, ahead[s] * part.dt, space.stage_velocities);
        add_scaled(space.stage.velocities, ahead[s] * part.dt, space.acceleration);
    }
    add_scaled(state.positions, part.dt, space.velocity_sum);
    add_scaled(state.velocities, part.dt, space.acceleration_sum);
}

}  // namespace

void step_explicit(Scheme scheme, const ExplicitPart& part, ExplicitSpace& space, ClothState& state) {
    start(part, space, state);
    set_prescribed_velocities(part, state);
    if (scheme == Scheme::forward_euler) step_forward_euler(part, space, state);
    if (scheme == Scheme::symplectic_euler) step_symplectic_euler(part, space, state);
    if (scheme == Scheme::midpoint) step_midpoint(part, space, state);
    if (scheme == Scheme::rk4) step_rk4(part, space, state);
    finish(part, state);
}

}  // namespace percale
