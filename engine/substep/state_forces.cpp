#include "state_forces.h"

#include "forces/springs.h"
#include "forces/wind.h"
#include "support/stage_timer.h"

namespace percale {
namespace {

double wind_power(const Workspace& work) { return work.explicit_space.forces.wind_power; }

ForcePlace place_of(const ClothState& state, std::span<const double> rest_length) {
    return {state.positions, state.velocities, state.positions, rest_length};
}

}  // namespace

StepWind* set_wind_at(const StepScene& scene, const Vec3Arrays& positions, Workspace& work) {
    if (!scene.plan.wind) return nullptr;
    set_step_wind(scene.model, *scene.settings.wind, scene.settings.air_density, positions, work.wind);
    return &work.wind;
}

void evaluate_at(const StepScene& scene, const ForcePlace& place, Workspace& work) {
    ExplicitSpace& space = work.explicit_space;
    set_step_springs(scene.compute,
                     {scene.model.adjacency, place.positions, DampingForm::velocity, scene.settings.time_step, place.rest_length,
                      &scene.model.springs},
                     space.springs);
    evaluate_forces({.compute = &scene.compute,
                     .model = &scene.model,
                     .springs = &space.springs,
                     .positions = &place.positions,
                     .velocities = &place.velocities,
                     .gravity = scene.settings.gravity,
                     .wind = set_wind_at(scene, place.air, work),
                     .dt = scene.settings.time_step,
                     .with_matrix = false},
                    space.forces);
}

void set_accelerations(const StepScene& scene, const ForcePlace& place, Workspace& work, Vec3Arrays& accelerations) {
    StageTimer timer(work.times.force);
    evaluate_at(scene, place, work);
    accelerations.resize(scene.model.vertex_count());
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) accelerations.set(i, work.explicit_space.forces.total.at(i) / scene.model.mass[i]);
    }
}

ScriptWork script_work(const StepScene& scene, const ClothState& start, const ClothState& end, double length, Workspace& work) {
    if (!scene.plan.pin_work && !(scene.plan.wind && scene.plan.measures)) return {};
    evaluate_at(scene, place_of(start, end.rest_length), work);
    work.explicit_space.start_forces = work.explicit_space.forces.total;
    const double start_power = wind_power(work);
    evaluate_at(scene, place_of(end, end.rest_length), work);
    ScriptWork done{.wind = 0.5 * length * (start_power + wind_power(work))};
    if (!scene.plan.pin_work) return done;
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) continue;
        const Vec3 force = 0.5 * (work.explicit_space.start_forces.at(i) + work.explicit_space.forces.total.at(i));
        const double before = start.velocities.at(i).squaredNorm(), after = end.velocities.at(i).squaredNorm();
        done.pins += 0.5 * scene.model.mass[i] * (after - before) - force.dot(end.positions.at(i) - start.positions.at(i));
    }
    return done;
}

}  // namespace percale
