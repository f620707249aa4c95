#include "scripted_motion.h"

#include "schemes/schemes.h"
#include "plan/planning.h"

namespace percale {
namespace {

/// Of all seams with the rest lengths that they have at a place of the span, J; the lengths stay.
double seam_energy(World& world, double place, const Vectors& positions) {
    const double at = world.part.from + place * (world.part.to - world.part.from);
    double energy = 0.0;
    for (const Seam& seam : world.script.seams) {
        energy += set_seam_lengths(seam, world.time + at * world.settings.time_step, positions, world.model);
    }
    return energy;
}

}  // namespace

void set_targets(World& world) {
    update_plan(world);
    for (std::size_t k = 0; k < world.script.obstacles.size(); ++k) {
        ObstacleState& obstacle = world.script.obstacles[k];
        const bool stays = obstacle.start == obstacle.end;
        if (stays && obstacle.settled && !world.plan.still_obstacles) continue;
        world.detector->move_obstacle(static_cast<int>(k), obstacle.start, obstacle.end);
        obstacle.settled = stays;
    }
}

void finish_motion(World& world) {
    for (ObstacleState& obstacle : world.script.obstacles) obstacle.start = obstacle.end;
}

void set_seams_at(World& world, double place) {
    if (world.plan.seams_close) seam_energy(world, place, world.state.positions);
}

double seam_work(World& world, const Vectors& start) {
    if (!world.plan.seams_close) return 0.0;
    const double before = seam_energy(world, 0.0, start);
    double work = 0.0;
    for (const auto& [share, place] : stage_weights(world.plan.scheme)) {
        if (share == 0.0) continue;
        const double at_start = seam_energy(world, place, start) - before;
        work += share * (at_start - seam_energy(world, place, world.state.positions));
    }
    return work + seam_energy(world, 1.0, world.state.positions);
}

StepWind* set_wind_at(World& world, const Vectors& positions) {
    if (!world.plan.wind) return nullptr;
    set_step_wind(world.model, *world.settings.wind, world.settings.air_density, positions, world.wind);
    return &world.wind;
}

void set_part_targets(World& world, double fraction) {
    world.part_targets.resize(world.model.vertex_count());
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] > 0.0) continue;
        const Vec3 start = world.before.positions.at(i), end = world.script.pin_targets.at(i);
        world.part_targets.set(i, fraction == 1.0 ? end : Vec3(start + fraction * (end - start)));
    }
}

}  // namespace percale
