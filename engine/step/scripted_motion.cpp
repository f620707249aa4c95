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

void set_part_targets(World& world, double fraction) {
    world.part_targets.resize(world.model.vertex_count());
    for (int i = 0; i < world.model.vertex_count(); ++i) {
        if (world.script.free[i] > 0.0) continue;
        const Vec3 start = world.before.positions.at(i), end = world.script.pin_targets.at(i);
        world.part_targets.set(i, fraction == 1.0 ? end : Vec3(start + fraction * (end - start)));
    }
}

}  // namespace percale
