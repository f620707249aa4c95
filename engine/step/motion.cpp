#include "motion.h"

namespace percale {

void tell_obstacles(StepScene& scene) {
    for (std::size_t k = 0; k < scene.script.obstacles.size(); ++k) {
        ObstacleState& obstacle = scene.script.obstacles[k];
        const bool stays = obstacle.start == obstacle.end;
        if (stays && obstacle.settled && !scene.plan.still_obstacles) continue;
        scene.detector->move_obstacle(static_cast<int>(k), obstacle.start, obstacle.end);
        obstacle.settled = stays;
    }
}

void finish_motion(StepScene& scene) {
    for (ObstacleState& obstacle : scene.script.obstacles) obstacle.start = obstacle.end;
}

}  // namespace percale
