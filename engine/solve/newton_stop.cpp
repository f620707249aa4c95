#include "newton_stop.h"

#include <algorithm>
#include <cmath>

#include "contact/contact_law.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Largest StepSettings::newton_error_ratio in adaptive steps. Larger: the solver's error exceeds the tolerance.
constexpr double max_adaptive_ratio = 0.25;

/// h over the smallest change that means something without contact (2e-5 h). Smaller: cloth near rest is left unsolved.
constexpr double thickness_over_smallest_change = 5e4;

/// Fraction of an adaptive stage's allowance below which a change means nothing.
constexpr double negligible_allowance_ratio = 0.1;

/// How much more a cloth's worst vertex may change than its mean without contact, over its own time error. In contact 1: where it
/// may be wrong by more than it changes, it trembles for ever.
constexpr double worst_vertex_factor = 4.0;

/// How much larger the smallest meaningful change of a cloth's worst vertex is than that of its mean.
constexpr double worst_vertex_floor_factor = 10.0;

/// How much the contact forces on a body may change over a line at whose end it is solved: by this factor and by this fraction of
/// its weight. Larger: as the force of contact is not linear, Newton halves a force that is far too large from line to line, and
/// would stop there: friction holds what should slide, and surfaces that move throw cloth off. Smaller: more iterations.
constexpr double settled_force_ratio = 1.5, negligible_weight_ratio = 0.05;

/// Accuracy of the linear solve, relative in the energy norm. Larger: more Newton iterations. Smaller: each is more expensive.
constexpr double linear_energy_accuracy = 0.2;

/// Relative residual at which a linear solve ends, whatever its energy.
constexpr double min_linear_residual = 1e-10;

/// With a residual to reach, the linear residual follows Newton's: factor of the squared ratio, its minimum and its maximum
/// (Eisenstat and Walker 1996, choice 2, gamma = 0.9).
constexpr double forcing_factor = 0.9, min_forcing = 1e-6, max_forcing = 0.1;

/// Fraction of the residual to reach that the last linear solve aims at, and the largest linear residual at all.
constexpr double last_forcing_ratio = 0.3, loosest_forcing = 0.3;

double squared_from(const TimeError& error, int first, int count, const Vec3Arrays& velocities, const Vec3Arrays& from) {
    const double *free = error.free->data(), *mass = error.model->mass.data();
    return sum_terms(*error.compute, first, count,
                     [&](int i) { return free[i] * mass[i] * square_between(velocities, from, i); });
}

/// The same for the worst vertex of a cloth, m^2/s^2.
double largest_error(const TimeError& error, const ClothRange& cloth, const Vec3Arrays& velocities) {
    const auto largest_from = [&](const Vec3Arrays& from) {
        return largest_term(*error.compute, cloth.first, cloth.count, [&](int i) { return square_between(velocities, from, i); });
    };
    const double change = largest_from(*error.start);
    if (!error.extrapolated) return change;
    return std::min(change, error.extrapolated_error_ratio * error.extrapolated_error_ratio * largest_from(*error.extrapolated));
}

}  // namespace

double squared_error(const TimeError& error, int first, int count, const Vec3Arrays& velocities) {
    const double change = squared_from(error, first, count, velocities, *error.start);
    if (!error.extrapolated) return change;
    const double unforeseen = squared_from(error, first, count, velocities, *error.extrapolated);
    return std::min(change, error.extrapolated_error_ratio * error.extrapolated_error_ratio * unforeseen);
}

double allowed_error_ratio(const StepSettings& settings) {
    return settings.adaptive ? std::min(settings.newton_error_ratio, max_adaptive_ratio) : settings.newton_error_ratio;
}

TimeError time_error_of(const ImplicitStage& stage) {
    const Vec3Arrays& extrapolated = stage.base.extrapolated;
    const StepSettings& settings = stage.scene.settings;
    TimeError error{.compute = &stage.scene.compute,
                    .model = &stage.scene.model,
                    .free = &stage.scene.script.free,
                    .dt = stage.base.h,
                    .start = &stage.start.velocities,
                    .extrapolated = extrapolated.padded_size() > 0 ? &extrapolated : nullptr,
                    .extrapolated_error_ratio = stage.base.error_ratio};
    if (settings.adaptive) error.allowance = settings.tolerance * stage.base.h;
    return error;
}

bool change_is_small(const TimeError& error, const NewtonChange& change, double error_ratio, const Body& body) {
    const ClothModel& model = *error.model;
    const auto first = model.cloths.begin() + cloth_of(model, body.first);
    const auto last = model.cloths.begin() + cloth_of(model, body.first + body.count - 1);
    const double worst_ratio = (change.in_contact ? 1.0 : worst_vertex_factor) * error_ratio;
    return std::all_of(first, last + 1, [&](const ClothRange& cloth) {
        const Vec3Arrays &residual = change.residual, &direction = change.direction;
        const double gain = -sum_terms(*error.compute, cloth.first, cloth.count, [&](int i) {
            return residual.x[i] * direction.x[i] + residual.y[i] * direction.y[i] + residual.z[i] * direction.z[i];
        });
        const double worst =
            largest_term(*error.compute, cloth.first, cloth.count, [&](int i) { return square_at(direction, i); });
        const double worst_error = largest_error(error, cloth, change.ahead);
        const double moved = error.dt * std::sqrt(std::max(gain, 0.0) / cloth.mass);
        const double time_error =
            0.5 * error.dt * std::sqrt(squared_error(error, cloth.first, cloth.count, change.ahead) / cloth.mass);
        const double thickness = model.thickness[cloth.first];
        const double min = change.in_contact ? contact_accuracy * thickness : thickness / thickness_over_smallest_change;
        const double floor = std::min(min, negligible_allowance_ratio * error.allowance);
        return moved <= error_ratio * time_error + floor &&
               error.dt * std::sqrt(worst) <=
                   worst_ratio * 0.5 * error.dt * std::sqrt(worst_error) + worst_vertex_floor_factor * floor;
    });
}

void contact_accelerations(const ClothModel& model, const StagePoint& point, std::vector<double>& accelerations) {
    accelerations.assign(model.bodies.size(), 0.0);
    const ContactConstraints& constraints = point.constraints;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
            const int i = constraints.vertex[constraint][k];
            const double force = constraints.weight[constraint][k] * point.constraint_forces[constraint].normal;
            accelerations[body_of(model.bodies, i)] += force * force / model.mass[i];
        }
    }
    for (std::size_t b = 0; b < accelerations.size(); ++b) accelerations[b] = std::sqrt(accelerations[b] / model.bodies[b].mass);
}

bool contact_is_settled(double before, double now, double gravity) {
    return std::max(before, now) <= settled_force_ratio * std::min(before, now) + negligible_weight_ratio * gravity;
}

double time_error(const TimeError& error, const Vec3Arrays& velocities) {
    double largest = 0.0;
    for (const ClothRange& cloth : error.model->cloths) {
        largest = std::max(largest, squared_error(error, cloth.first, cloth.count, velocities) / cloth.mass);
    }
    return 0.5 * error.dt * std::sqrt(largest);
}

SolveTarget solve_target(const TimeError& error, const NewtonProgress& progress, const StepSettings& settings,
                         const Vec3Arrays& velocities) {
    const bool first = progress.iteration == 0;
    if (const auto& tolerance = settings.newton_tolerance) {
        const double wanted = last_forcing_ratio * *tolerance / std::max(progress.residual, 1e-300);
        const double forcing =
            first ? max_forcing : std::clamp(forcing_factor * progress.ratio * progress.ratio, min_forcing, max_forcing);
        return {.relative_residual = std::min(loosest_forcing, std::max(forcing, wanted))};
    }
    const double accuracy = linear_energy_accuracy * std::min(1.0, allowed_error_ratio(settings));
    const double error_now = first ? 0.0 : squared_error(error, 0, error.model->vertex_count(), velocities);
    return {
        .relative_residual = min_linear_residual, .relative_gain = accuracy, .absolute_gain = accuracy * accuracy * error_now};
}

}  // namespace percale
