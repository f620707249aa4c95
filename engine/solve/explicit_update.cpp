#include "explicit_update.h"

namespace percale {
namespace {

/// space.forces at a state.
void evaluate(const ExplicitPart& part, const ClothState& state, ExplicitSpace& space) {
    if (part.wind) {
        set_step_wind(*part.model, part.wind->velocity, part.wind->density, state.positions, *part.wind);
    }
    const ForceInput input{.compute = part.compute,
                           .model = part.model,
                           .springs = &space.springs,
                           .positions = &state.positions,
                           .velocities = &state.velocities,
                           .gravity = part.settings->gravity,
                           .wind = part.wind,
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

/// (v)_i += dt f_i/m_i along one axis, where a vertex is free.
void kick(const ExplicitPart& part, const AlignedVector<double>& force, AlignedVector<double>& velocity) {
    const double *f = force.data(), *mass = part.model->mass.data(), *free = part.free->data();
    double* __restrict__ v = velocity.data();
    for (int i = 0; i < part.model->vertex_count(); ++i) {
        const double change = part.dt * f[i] / mass[i];
        v[i] += free[i] > 0.0 ? change : 0.0;
    }
}

void step_symplectic_euler(const ExplicitPart& part, ExplicitSpace& space, ClothState& state) {
    evaluate(part, state, space);
    kick(part, space.forces.total.x, state.velocities.x);
    kick(part, space.forces.total.y, state.velocities.y);
    kick(part, space.forces.total.z, state.velocities.z);
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

/// A stage of Runge and Kutta's: the weight of its slopes, and how far along them the next one is, s.
struct Stage {
    double weight, ahead;
};

/// Along one axis: adds the slopes of the stage at (x, v), where the force is f, to their sums, and makes the next stage of the
/// state at the start of the step. One pass, since what it reads and writes costs as much as the springs.
void advance_axis(const ExplicitPart& part, const Stage& stage, AlignedVector<double> Vectors::*axis, const ClothState& start,
                  ExplicitSpace& space) {
    const double *mass = part.model->mass.data(), *free = part.free->data();
    const double *f = (space.forces.total.*axis).data(), *x0 = (start.positions.*axis).data(),
                 *v0 = (start.velocities.*axis).data();
    double* __restrict__ x = (space.stage.positions.*axis).data();
    double* __restrict__ v = (space.stage.velocities.*axis).data();
    double* __restrict__ v_sum = (space.velocity_sum.*axis).data();
    double* __restrict__ a_sum = (space.acceleration_sum.*axis).data();
    for (int i = 0; i < part.model->vertex_count(); ++i) {
        const double quotient = f[i] / mass[i], a = free[i] > 0.0 ? quotient : 0.0, velocity = v[i];
        v_sum[i] += stage.weight * velocity;
        a_sum[i] += stage.weight * a;
        x[i] = x0[i] + stage.ahead * velocity;
        v[i] = v0[i] + stage.ahead * a;
    }
}

void step_rk4(const ExplicitPart& part, ExplicitSpace& space, ClothState& state) {
    const Stage stages[] = {{1.0 / 6.0, 0.5 * part.dt}, {1.0 / 3.0, 0.5 * part.dt}, {1.0 / 3.0, part.dt}, {1.0 / 6.0, 0.0}};
    space.velocity_sum.resize(part.model->vertex_count());
    space.acceleration_sum.resize(part.model->vertex_count());
    space.stage.positions = state.positions;
    space.stage.velocities = state.velocities;
    for (const Stage& stage : stages) {
        evaluate(part, space.stage, space);
        for (const auto axis : {&Vectors::x, &Vectors::y, &Vectors::z}) advance_axis(part, stage, axis, state, space);
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
