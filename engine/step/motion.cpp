#include "motion.h"

#include <algorithm>
#include <cmath>

#include "tolerances.h"
#include "world.h"

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

namespace {

/// The largest number of parts that anything asks for so far, and what does.
struct PartsAsked {
    double parts = 1.0;
    MotionParts most = {};

    void by_obstacle(const StepScene& scene, int number, std::span<const ClothAhead> cloths) {
        const ObstacleState& obstacle = scene.script.obstacles[number];
        const Pose &start = obstacle.start, &end = obstacle.end;
        const double turns = angle_between(start.rotation, end.rotation) / largest_part_turn;
        for (const ClothAhead& cloth : cloths) {
            if (!cloth.meets(start.translation, end.translation, obstacle.reach)) continue;
            const double travel = travel_beside(cloth, end.translation - start.translation);
            const double asked = std::max(turns, travel / (largest_part_travel * cloth.thickness()));
            if (asked <= parts) continue;
            parts = asked;
            most = {.obstacle = number, .travel = travel};
        }
    }

    void by_pin(int vertex, const Vec3& displacement, const ClothAhead& cloth) {
        const double travel = travel_beside(cloth, displacement);
        if (travel <= parts * largest_pin_travel * cloth.thickness()) return;
        parts = travel / (largest_pin_travel * cloth.thickness());
        most = {.vertex = vertex, .travel = travel};
    }

private:
    /// Cloth that falls past what hardly moves is the solver's alone.
    static double travel_beside(const ClothAhead& cloth, const Vec3& displacement) {
        return std::min(displacement.norm(), cloth.beside(displacement).norm());
    }
};

/// The numbers of pinned vertices that are to be somewhere else.
std::vector<int> moving_pins(const StepScene& scene, const ClothState& state) {
    std::vector<int> pins;
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (!scene.is_free(i) && state.positions.at(i) != scene.script.pin_targets.at(i)) pins.push_back(i);
    }
    return pins;
}

}  // namespace

MotionParts motion_parts(const StepScene& scene, const ClothState& state) {
    if (!scene.detector || (scene.script.obstacles.empty() && !meets_cloth(scene))) return {};
    const auto moves = [](const ObstacleState& obstacle) { return !(obstacle.start == obstacle.end); };
    const std::vector<int> pins = moving_pins(scene, state);
    if (pins.empty() && std::ranges::none_of(scene.script.obstacles, moves)) return {};
    std::vector<ClothAhead> cloths;
    for (const ClothRange& cloth : scene.model.cloths) cloths.push_back(cloth_ahead(scene, cloth, state));
    PartsAsked asked;
    for (int k = 0; k < static_cast<int>(scene.script.obstacles.size()); ++k) {
        if (moves(scene.script.obstacles[k])) asked.by_obstacle(scene, k, cloths);
    }
    for (const int i : pins) {
        const ClothRange& cloth = scene.model.cloths[cloth_of(scene.model, i)];
        if (scene.script.obstacles.empty() && !cloth.fabric.self_contact) continue;
        const Vec3 displacement = scene.script.pin_targets.at(i) - state.positions.at(i);
        asked.by_pin(i, displacement, cloths[cloth_of(scene.model, i)]);
    }
    asked.most.count = static_cast<int>(std::ceil(std::min(asked.parts, 2.0 * most_step_parts) - part_rounding));
    return asked.most;
}

}  // namespace percale
