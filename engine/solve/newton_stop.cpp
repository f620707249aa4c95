#include "newton_stop.h"

#include <algorithm>
#include <cmath>

#include "contact/contact_law.h"
#include "tolerances.h"

namespace percale {
namespace {

double squared_from(const TimeError& error, int first, int count, const Vectors& velocities, const Vectors& from) {
    const double *free = error.free->data(), *mass = error.model->mass.data();
    return sum_terms(*error.compute, first, count,
                     [&](int i) { return free[i] * mass[i] * square_between(velocities, from, i); });
}

/// The same for the worst vertex of a cloth, m^2/s^2.
double largest_error(const TimeError& error, const ClothRange& cloth, const Vectors& velocities) {
    const auto largest_from = [&](const Vectors& from) {
        return largest_term(*error.compute, cloth.first, cloth.count, [&](int i) { return square_between(velocities, from, i); });
    };
    const double change = largest_from(*error.start);
    if (!error.foreseen) return change;
    return std::min(change, error.foreseen_share * error.foreseen_share * largest_from(*error.foreseen));
}

}  // namespace

double squared_error(const TimeError& error, int first, int count, const Vectors& velocities) {
    const double change = squared_from(error, first, count, velocities, *error.start);
    if (!error.foreseen) return change;
    const double unforeseen = squared_from(error, first, count, velocities, *error.foreseen);
    return std::min(change, error.foreseen_share * error.foreseen_share * unforeseen);
}

double allowed_share(const StepSettings& settings) {
    return settings.adaptive ? std::min(settings.newton_share, most_adaptive_share) : settings.newton_share;
}

TimeError time_error_of(const ImplicitStage& stage) {
    const Vectors& foreseen = stage.base.foreseen;
    const StepSettings& settings = stage.scene.settings;
    TimeError error{.compute = &stage.scene.compute,
                    .model = &stage.scene.model,
                    .free = &stage.scene.script.free,
                    .dt = stage.base.h,
                    .start = &stage.start.velocities,
                    .foreseen = foreseen.padded_size() > 0 ? &foreseen : nullptr,
                    .foreseen_share = stage.base.error_share};
    if (settings.adaptive) error.allowance = settings.tolerance * stage.base.h;
    return error;
}

NewtonChange change_to(const StageEquations& equations, const Vectors& ahead) {
    const StagePoint& point = equations.space().current;
    return {point.residual, equations.space().direction, ahead, point.rows.size() > 0};
}

bool change_is_small(const TimeError& error, const NewtonChange& change, double share, const Body& body) {
    const ClothModel& model = *error.model;
    const auto first = model.cloths.begin() + cloth_of(model, body.first);
    const auto last = model.cloths.begin() + cloth_of(model, body.first + body.count - 1);
    return std::all_of(first, last + 1, [&](const ClothRange& cloth) {
        const Vectors &residual = change.residual, &direction = change.direction;
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
        const double least = change.in_contact ? contact_accuracy * thickness : thickness / thickness_over_smallest_change;
        const double floor = std::min(least, negligible_allowance_share * error.allowance);
        return moved <= share * time_error + floor &&
               error.dt * std::sqrt(worst) <=
                   worst_vertex_factor * share * error.dt * std::sqrt(worst_error) + worst_vertex_floor_factor * floor;
    });
}

double time_error(const TimeError& error, const Vectors& velocities) {
    double largest = 0.0;
    for (const ClothRange& cloth : error.model->cloths) {
        largest = std::max(largest, squared_error(error, cloth.first, cloth.count, velocities) / cloth.mass);
    }
    return 0.5 * error.dt * std::sqrt(largest);
}

SolveTarget solve_target(const TimeError& error, const NewtonProgress& progress, const StepSettings& settings,
                         const Vectors& velocities) {
    const bool first = progress.iteration == 0;
    if (const auto& tolerance = settings.newton_tolerance) {
        const double wanted = last_forcing_share * *tolerance / std::max(progress.residual, 1e-300);
        const double forcing =
            first ? most_forcing : std::clamp(forcing_factor * progress.ratio * progress.ratio, least_forcing, most_forcing);
        return {.relative_residual = std::min(loosest_forcing, std::max(forcing, wanted))};
    }
    const double accuracy = linear_energy_accuracy * std::min(1.0, allowed_share(settings));
    const double error_now = first ? 0.0 : squared_error(error, 0, error.model->vertex_count(), velocities);
    return {
        .relative_residual = least_linear_residual, .relative_gain = accuracy, .absolute_gain = accuracy * accuracy * error_now};
}

}  // namespace percale
