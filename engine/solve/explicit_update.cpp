#include "explicit_update.h"

#include "forces/springs.h"
#include "forces/wind.h"

namespace percale {
namespace {

/// Sets space.forces at a state.
void evaluate(const ExplicitStep& step, const ClothState& state, ExplicitSpace& space) {
    if (step.wind) {
        set_step_wind(step.scene.model, step.wind->velocity, step.wind->density, state.positions, *step.wind);
    }
    const ForceInput input{.compute = &step.scene.compute,
                           .model = &step.scene.model,
                           .springs = &space.springs,
                           .positions = &state.positions,
                           .velocities = &state.velocities,
                           .gravity = step.scene.settings.gravity,
                           .wind = step.wind,
                           .dt = step.dt,
                           .with_matrix = false};
    evaluate_forces(input, space.forces);
}

void start(const ExplicitStep& step, ExplicitSpace& space, const ClothState& state) {
    set_step_springs(step.scene.compute,
                     {step.scene.model.adjacency, state.positions, DampingForm::velocity, step.dt, step.rest_length,
                      &step.scene.model.springs},
                     space.springs);
}

bool is_free(const ExplicitStep& step, int i) { return step.scene.is_free(i); }

/// space.acceleration = f/m at a state; 0 at prescribed vertices.
void accelerate(const ExplicitStep& step, const ClothState& state, ExplicitSpace& space) {
    evaluate(step, state, space);
    space.acceleration.resize(step.scene.model.vertex_count());
    for (int i = 0; i < step.scene.model.vertex_count(); ++i) {
        if (is_free(step, i)) space.acceleration.set(i, space.forces.total.at(i) / step.scene.model.mass[i]);
    }
}

/// The velocity with which prescribed vertices reach their targets.
void set_prescribed_velocities(const ExplicitStep& step, ClothState& state) {
    for (int i = 0; i < step.scene.model.vertex_count(); ++i) {
        if (is_free(step, i)) continue;
        state.velocities.set(i, (step.targets.at(i) - state.positions.at(i)) / step.dt);
    }
}

void finish(const ExplicitStep& step, ClothState& state) {
    for (int i = 0; i < step.scene.model.vertex_count(); ++i) {
        if (!is_free(step, i)) state.positions.set(i, step.targets.at(i));
    }
    update_points(state);
}

/// (v)_i += dt f_i/m_i along one axis, where a vertex is free.
void kick(const ExplicitStep& step, const AlignedVector<double>& force, AlignedVector<double>& velocity) {
    const double *f = force.data(), *mass = step.scene.model.mass.data(), *free = step.scene.script.free.data();
    double* __restrict__ v = velocity.data();
    for (int i = 0; i < step.scene.model.vertex_count(); ++i) {
        const double change = step.dt * f[i] / mass[i];
        v[i] += free[i] > 0.0 ? change : 0.0;
    }
}

void step_symplectic_euler(const ExplicitStep& step, ExplicitSpace& space, ClothState& state) {
    evaluate(step, state, space);
    kick(step, space.forces.total.x, state.velocities.x);
    kick(step, space.forces.total.y, state.velocities.y);
    kick(step, space.forces.total.z, state.velocities.z);
    add_scaled(state.positions, step.dt, state.velocities);
}

void step_forward_euler(const ExplicitStep& step, ExplicitSpace& space, ClothState& state) {
    accelerate(step, state, space);
    add_scaled(state.positions, step.dt, state.velocities);
    add_scaled(state.velocities, step.dt, space.acceleration);
}

void step_midpoint(const ExplicitStep& step, ExplicitSpace& space, ClothState& state) {
    accelerate(step, state, space);
    space.stage.positions = state.positions;
    space.stage.velocities = state.velocities;
    add_scaled(space.stage.positions, 0.5 * step.dt, state.velocities);
    add_scaled(space.stage.velocities, 0.5 * step.dt, space.acceleration);
    accelerate(step, space.stage, space);
    add_scaled(state.positions, step.dt, space.stage.velocities);
    add_scaled(state.velocities, step.dt, space.acceleration);
}

/// A stage of Runge and Kutta: the weight of its slopes, and the distance to the next stage along them, s.
struct ExplicitStage {
    double weight, ahead;
};

/// One axis of all arrays that a stage reads and writes.
struct StageAxis {
    const double *force, *mobility;  // N; 1/m, 0 where a vertex is prescribed, 1/kg
    double *x0, *v0;                 // at the start of the step, and at its end
    double *x, *v;                   // of the stage
    double *v_sum, *a_sum;           // of the slopes
};

enum class StagePlace { first, between, last };

/// Adds the slopes of a stage to their sums and makes the next one, or the end of the step, in one pass: separate passes would
/// cost as much as the springs. The first stage is the start itself. It works slice by slice and reads everything before it
/// writes, so that compilers need not assume overlapping arrays.
template <StagePlace place>
void advance(const StageAxis& axis, const ExplicitStage& stage, double dt, std::size_t padded) {
    constexpr int lanes = Vec3Arrays::lanes;
    const double weight = stage.weight, ahead = stage.ahead;
    for (std::size_t i = 0; i < padded; i += lanes) {
        double a[lanes], velocity[lanes], x[lanes], v[lanes];
        for (int k = 0; k < lanes; ++k) a[k] = axis.force[i + k] * axis.mobility[i + k];
        for (int k = 0; k < lanes; ++k) velocity[k] = (place == StagePlace::first ? axis.v0 : axis.v)[i + k];
        for (int k = 0; k < lanes; ++k) x[k] = axis.x0[i + k];
        for (int k = 0; k < lanes; ++k) v[k] = axis.v0[i + k];
        double v_sum[lanes] = {}, a_sum[lanes] = {};
        if constexpr (place != StagePlace::first) {
            for (int k = 0; k < lanes; ++k) v_sum[k] = axis.v_sum[i + k];
            for (int k = 0; k < lanes; ++k) a_sum[k] = axis.a_sum[i + k];
        }
        for (int k = 0; k < lanes; ++k) v_sum[k] += weight * velocity[k];
        for (int k = 0; k < lanes; ++k) a_sum[k] += weight * a[k];
        if constexpr (place == StagePlace::last) {
            for (int k = 0; k < lanes; ++k) axis.x0[i + k] = x[k] + dt * v_sum[k];
            for (int k = 0; k < lanes; ++k) axis.v0[i + k] = v[k] + dt * a_sum[k];
        } else {
            for (int k = 0; k < lanes; ++k) axis.v_sum[i + k] = v_sum[k];
            for (int k = 0; k < lanes; ++k) axis.a_sum[i + k] = a_sum[k];
            for (int k = 0; k < lanes; ++k) axis.x[i + k] = x[k] + ahead * velocity[k];
            for (int k = 0; k < lanes; ++k) axis.v[i + k] = v[k] + ahead * a[k];
        }
    }
}

template <StagePlace place>
void make_stage(const ExplicitStep& step, const ExplicitStage& stage, ExplicitSpace& space, ClothState& state) {
    evaluate(step, place == StagePlace::first ? state : space.stage, space);
    for (const auto axis : {&Vec3Arrays::x, &Vec3Arrays::y, &Vec3Arrays::z}) {
        advance<place>({.force = (space.forces.total.*axis).data(),
                        .mobility = space.mobility.data(),
                        .x0 = (state.positions.*axis).data(),
                        .v0 = (state.velocities.*axis).data(),
                        .x = (space.stage.positions.*axis).data(),
                        .v = (space.stage.velocities.*axis).data(),
                        .v_sum = (space.velocity_sum.*axis).data(),
                        .a_sum = (space.acceleration_sum.*axis).data()},
                       stage, step.dt, state.positions.padded_size());
    }
}

/// Allocates the stages and sets 1/m of free vertices.
void begin_stages(const ExplicitStep& step, ExplicitSpace& space, const ClothState& state) {
    const int count = step.scene.model.vertex_count();
    const std::size_t padded = state.positions.padded_size();
    for (Vec3Arrays* vectors : {&space.stage.positions, &space.stage.velocities, &space.velocity_sum, &space.acceleration_sum})
        if (vectors->padded_size() != padded) vectors->resize(count);
    space.mobility.resize(padded, 0.0);
    const double *mass = step.scene.model.mass.data(), *free = step.scene.script.free.data();
    for (int i = 0; i < count; ++i) space.mobility[i] = free[i] / mass[i];
}

void step_rk4(const ExplicitStep& step, ExplicitSpace& space, ClothState& state) {
    begin_stages(step, space, state);
    make_stage<StagePlace::first>(step, {1.0 / 6.0, 0.5 * step.dt}, space, state);
    make_stage<StagePlace::between>(step, {1.0 / 3.0, 0.5 * step.dt}, space, state);
    make_stage<StagePlace::between>(step, {1.0 / 3.0, step.dt}, space, state);
    make_stage<StagePlace::last>(step, {1.0 / 6.0, 0.0}, space, state);
}

}  // namespace

void step_explicit(Scheme scheme, const ExplicitStep& step, ExplicitSpace& space, ClothState& state) {
    start(step, space, state);
    set_prescribed_velocities(step, state);
    if (scheme == Scheme::forward_euler) step_forward_euler(step, space, state);
    if (scheme == Scheme::symplectic_euler) step_symplectic_euler(step, space, state);
    if (scheme == Scheme::midpoint) step_midpoint(step, space, state);
    if (scheme == Scheme::rk4) step_rk4(step, space, state);
    finish(step, state);
}

}  // namespace percale
