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

/// One axis of all that a stage reads and writes.
struct StageAxis {
    const double *force, *mobility;  // N; 1/m, 0 where a vertex is prescribed, 1/kg
    double *x0, *v0;                 // at the start of the step, and at its end
    double *x, *v;                   // of the stage
    double *v_sum, *a_sum;           // of the slopes
};

enum class StagePlace { first, between, last };

/// Adds the slopes of a stage to their sums and makes the next one, or the end of the step, in one pass: what is read and written
/// here would else cost as much as the springs. The first stage is the start itself. Slice by slice, everything read before
/// anything is written, so that compilers need not fear that arrays overlap.
template <StagePlace place>
void advance(const StageAxis& axis, const Stage& stage, double dt, std::size_t padded) {
    constexpr int lanes = Vectors::lanes;
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
void make_stage(const ExplicitPart& part, const Stage& stage, ExplicitSpace& space, ClothState& state) {
    evaluate(part, place == StagePlace::first ? state : space.stage, space);
    for (const auto axis : {&Vectors::x, &Vectors::y, &Vectors::z}) {
        advance<place>({.force = (space.forces.total.*axis).data(),
                        .mobility = space.mobility.data(),
                        .x0 = (state.positions.*axis).data(),
                        .v0 = (state.velocities.*axis).data(),
                        .x = (space.stage.positions.*axis).data(),
                        .v = (space.stage.velocities.*axis).data(),
                        .v_sum = (space.velocity_sum.*axis).data(),
                        .a_sum = (space.acceleration_sum.*axis).data()},
                       stage, part.dt, state.positions.padded_size());
    }
}

/// Memory for the stages and 1/m of free vertices.
void begin_stages(const ExplicitPart& part, ExplicitSpace& space, const ClothState& state) {
    const int count = part.model->vertex_count();
    const std::size_t padded = state.positions.padded_size();
    for (Vectors* vectors : {&space.stage.positions, &space.stage.velocities, &space.velocity_sum, &space.acceleration_sum})
        if (vectors->padded_size() != padded) vectors->resize(count);
    space.mobility.resize(padded, 0.0);
    const double *mass = part.model->mass.data(), *free = part.free->data();
    for (int i = 0; i < count; ++i) space.mobility[i] = free[i] / mass[i];
}

void step_rk4(const ExplicitPart& part, ExplicitSpace& space, ClothState& state) {
    begin_stages(part, space, state);
    make_stage<StagePlace::first>(part, {1.0 / 6.0, 0.5 * part.dt}, space, state);
    make_stage<StagePlace::between>(part, {1.0 / 3.0, 0.5 * part.dt}, space, state);
    make_stage<StagePlace::between>(part, {1.0 / 3.0, part.dt}, space, state);
    make_stage<StagePlace::last>(part, {1.0 / 6.0, 0.0}, space, state);
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
