#include "scripted_motion.h"

#include "planning.h"

namespace percale {

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

void set_part_seams(World& world, StepFraction span) {
    world.seam_work = 0.0;
    if (!world.plan.seams_close) return;
    const double dt = world.settings.time_step;
    for (const Seam& seam : world.script.seams) {
        const double before = set_seam_lengths(seam, world.time + span.from * dt, world.state.positions, world.model);
        world.seam_work += set_seam_lengths(seam, world.time + span.to * dt, world.state.positions, world.model) - before;
    }
}

void set_seams_at(World& world, double fraction) {
    for (const Seam& seam : world.script.seams)
        set_seam_lengths(seam, world.time + fraction * world.settings.time_step, world.state.positions, world.model);
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
