#include "scripted_motion.h"

namespace percale {
namespace {

bool pin_moves(const World& world, int i) {
    return world.script.free[i] == 0.0 && world.script.pin_targets.at(i) != world.state.positions.at(i);
}

}  // namespace

void set_targets(World& world) {
    SceneFacts facts{.cloth_vertices = world.model.vertex_count(), .obstacles = static_cast<int>(world.script.obstacles.size())};
    for (int i = 0; i < world.model.vertex_count() && !facts.pins_move; ++i) facts.pins_move = pin_moves(world, i);
    for (std::size_t k = 0; k < world.script.obstacles.size(); ++k) {
        const ObstacleState& obstacle = world.script.obstacles[k];
        facts.obstacles_move = facts.obstacles_move || obstacle.start != obstacle.end;
        world.detector->move_obstacle(static_cast<int>(k), obstacle.start, obstacle.end);
    }
    world.plan = make_step_plan(world.settings, facts);
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
