#include "motion.h"

#include <algorithm>
#include <cmath>

#include "percale/cloth_ahead.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Parts of a step, asked for by the travel of one thing, from which the report states that it may have jumped.
constexpr int jump_parts = 8;

/// Largest motion in one part of a step: rotation of an obstacle in radians, and translations of an obstacle and of a pin in
/// thicknesses. Larger: parts that vertices on straight lines do not follow, and lists of contacts that grow. Smaller: more
/// parts.
constexpr double largest_part_turn = 0.26179938779914943, largest_part_travel = 20.0, largest_pin_travel = 80.0;

/// The excess of a count of parts over a whole number that is taken for rounding. Smaller: rounding adds a part. Larger: parts
/// that go farther than they may.
constexpr double part_rounding = 1e-9;

}  // namespace

void report_obstacles(StepScene& scene) {
    for (std::size_t k = 0; k < scene.script.obstacles.size(); ++k) {
        ObstacleState& obstacle = scene.script.obstacles[k];
        const bool stays = !obstacle.moves();
        if (stays && obstacle.settled && !scene.plan.still_obstacles) continue;
        obstacle.pass_to(*scene.detector, static_cast<int>(k));
        obstacle.settled = stays;
    }
}

void finish_motion(StepScene& scene) {
    for (ObstacleState& obstacle : scene.script.obstacles) obstacle.arrive();
}

namespace {

Vec3 displacement_of(const ObstacleState& obstacle) { return obstacle.end.translation - obstacle.start.translation; }

/// A cloth during the coming step if it continued its present motion.
ClothAhead cloth_ahead(const StepScene& scene, const ClothRange& cloth, const ClothState& state) {
    ClothAhead ahead(scene.model.thickness[cloth.first], scene.settings.time_step);
    for (int i = cloth.first; i < cloth.first + cloth.count; ++i) ahead.add(state.positions.at(i), state.velocities.at(i));
    return ahead;
}

/// The largest number of parts required so far, and what requires it.
struct PartsAsked {
    double parts = 1.0;
    MotionParts max = {};

    void by_obstacle(const StepScene& scene, int number, std::span<const ClothAhead> cloths) {
        const ObstacleState& obstacle = scene.script.obstacles[number];
        const Pose &start = obstacle.start, &end = obstacle.end;
        const double turns = angle_between(start.rotation, end.rotation) / largest_part_turn;
        for (const ClothAhead& cloth : cloths) {
            if (!cloth.meets(start.translation, end.translation, obstacle.reach)) continue;
            const double displacement = travel_beside(cloth, displacement_of(obstacle)),
                         travel = displacement + obstacle.shape_travel;
            const double asked = std::max(turns, travel / (largest_part_travel * cloth.thickness()));
            if (asked <= parts) continue;
            parts = asked;
            const bool jumps = displacement >= jump_parts * largest_part_travel * cloth.thickness();
            max = {.obstacle = number, .travel = travel, .jumps = jumps};
        }
    }

    void by_pin(int vertex, const Vec3& displacement, const ClothAhead& cloth) {
        const double travel = travel_beside(cloth, displacement);
        if (travel <= parts * largest_pin_travel * cloth.thickness()) return;
        parts = travel / (largest_pin_travel * cloth.thickness());
        max = {.vertex = vertex, .travel = travel, .jumps = parts >= jump_parts};
    }

private:
    /// Travel of an obstacle beside cloth. Cloth that falls past a body that hardly moves is left to the solver.
    static double travel_beside(const ClothAhead& cloth, const Vec3& displacement) {
        return std::min(displacement.norm(), cloth.beside(displacement).norm());
    }
};

/// Whether an obstacle translates or turns farther than a part allows, whatever the cloth does; `min_thickness` is the smallest
/// of any cloth.
bool goes_far(const ObstacleState& obstacle, double min_thickness) {
    if (!obstacle.moves()) return false;
    return displacement_of(obstacle).norm() + obstacle.shape_travel > largest_part_travel * min_thickness ||
           angle_between(obstacle.start.rotation, obstacle.end.rotation) > largest_part_turn;
}

/// Calls `work` with every pin of cloth with contact that moves farther than a part allows, and its displacement, m.
template <class Work>
void for_far_pins(const StepScene& scene, const ClothState& state, Work work) {
    for (const ClothRange& cloth : scene.model.cloths) {
        if (scene.script.obstacles.empty() && !cloth.fabric.self_contact) continue;
        const double max = largest_pin_travel * scene.model.thickness[cloth.first];
        for (int i = cloth.first; i < cloth.first + cloth.count; ++i) {
            if (scene.is_free(i)) continue;
            const Vec3 displacement = scene.script.pin_targets.at(i) - state.positions.at(i);
            if (displacement.norm() > max) work(i, displacement);
        }
    }
}

}  // namespace

MotionParts motion_parts(const StepScene& scene, const ClothState& state) {
    if (!scene.detector || scene.model.cloths.empty()) return {};
    const double thinnest = *std::ranges::min_element(scene.model.thickness);
    bool far = std::ranges::any_of(scene.script.obstacles, [&](const ObstacleState& o) { return goes_far(o, thinnest); });
    for_far_pins(scene, state, [&](int, const Vec3&) { far = true; });
    if (!far) return {};  // nearly always: what moves along with cloth may still travel far
    std::vector<ClothAhead> cloths;
    for (const ClothRange& cloth : scene.model.cloths) cloths.push_back(cloth_ahead(scene, cloth, state));
    PartsAsked asked;
    for (int k = 0; k < static_cast<int>(scene.script.obstacles.size()); ++k) {
        if (goes_far(scene.script.obstacles[k], thinnest)) asked.by_obstacle(scene, k, cloths);
    }
    for_far_pins(scene, state,
                 [&](int i, const Vec3& displacement) { asked.by_pin(i, displacement, cloths[cloth_of(scene.model, i)]); });
    asked.max.count = static_cast<int>(std::ceil(std::min(asked.parts, 2.0 * max_step_parts) - part_rounding));
    return asked.max;
}

}  // namespace percale
