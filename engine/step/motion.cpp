#include "motion.h"

#include <algorithm>
#include <cmath>

#include "tolerances.h"

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

ClothAhead cloth_ahead(const StepScene& scene, const ClothRange& cloth, const ClothState& state) {
    ClothAhead ahead(scene.model.thickness[cloth.first], scene.settings.time_step);
    for (int i = cloth.first; i < cloth.first + cloth.count; ++i) ahead.add(state.positions.at(i), state.velocities.at(i));
    return ahead;
}

MotionParts motion_parts(const StepScene& scene, const ClothState& state) {
    MotionParts most;
    std::vector<ClothAhead> cloths;  // made where an obstacle moves
    double parts = 1.0;
    for (std::size_t k = 0; k < scene.script.obstacles.size(); ++k) {
        const ObstacleState& obstacle = scene.script.obstacles[k];
        const Pose &start = obstacle.start, &end = obstacle.end;
        if (start == end) continue;
        if (cloths.empty()) {
            for (const ClothRange& cloth : scene.model.cloths) cloths.push_back(cloth_ahead(scene, cloth, state));
        }
        const double turns = angle_between(start.rotation, end.rotation) / largest_part_turn;
        for (const ClothAhead& cloth : cloths) {
            if (!cloth.meets(start.translation, end.translation, obstacle.reach)) continue;
            const Vec3 displacement = end.translation - start.translation;
            // Cloth that falls past a body which hardly moves is the solver's alone.
            const double travel = std::min(displacement.norm(), cloth.beside(displacement).norm());
            const double asked = std::max(turns, travel / (largest_part_travel * cloth.thickness()));
            if (asked <= parts) continue;
            parts = asked;
            most.obstacle = static_cast<int>(k);
            most.travel = travel;
        }
    }
    most.count = static_cast<int>(std::ceil(std::min(parts, 2.0 * most_step_parts) - part_rounding));
    return most;
}

}  // namespace percale
