#include "teleport.h"

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

/// Which cloths and obstacles take part.
struct Company {
    const ClothModel& model;
    std::span<const int> cloths, obstacles;

    bool has_cloth_of(int vertex) const { return std::ranges::count(cloths, cloth_of(model, vertex)) > 0; }
    bool has_obstacle(int obstacle) const { return std::ranges::count(obstacles, obstacle) > 0; }

    /// Releases the bond of a vertex with an obstacle, or with cloth (-1), whose vertex is not known.
    template <class Held>
    bool parts(const Held& held) const {
        if (held.obstacle < 0) return has_cloth_of(held.vertex);
        return has_cloth_of(held.vertex) != has_obstacle(held.obstacle);
    }
};

void move_cloth(World& world, const ClothRange& cloth, const Pose& motion, bool keep) {
    ClothState& state = world.state.cloth;
    const Pose turn{.rotation = motion.rotation};
    for (int i = cloth.first; i < cloth.first + cloth.count; ++i) {
        state.positions.set(i, transform(motion, state.positions.at(i)));
        world.scene.script.pin_targets.set(i, transform(motion, world.scene.script.pin_targets.at(i)));
        state.velocities.set(i, keep ? transform(turn, state.velocities.at(i)) : Vec3(Vec3::Zero()));
    }
}

/// Turns the directions of seams and of stick anchors.
void turn_directions(World& world, const Company& company, const Pose& motion) {
    const Pose turn{.rotation = motion.rotation};
    ClothState& state = world.state.cloth;
    std::erase_if(state.stick_anchors, [&](const StickAnchor& stick_anchor) { return company.parts(stick_anchor); });
    std::erase_if(state.impacts, [&](const Impact& impact) { return company.parts(impact); });
    for (StickAnchor& stick_anchor : state.stick_anchors) {
        if (company.has_cloth_of(stick_anchor.vertex)) stick_anchor.stretch = transform(turn, stick_anchor.stretch);
    }
    for (SewnPoint& point : world.scene.model.sewn_points) {
        if (company.has_cloth_of(point.stitch.vertex)) point.direction = transform(turn, point.direction);
    }
    for (Weld& weld : world.scene.model.welds) {
        if (company.has_cloth_of(weld.stitch.vertex)) weld.hold = transform(turn, weld.hold);
    }
}

Pose moved(const Pose& motion, const Pose& pose) {
    Rotation q = product(motion.rotation, pose.rotation);
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);  // 1, except for accumulated rounding
    q = {q.w / length, q.x / length, q.y / length, q.z / length};
    return {transform(motion, pose.translation), q, pose.scale};
}

}  // namespace

void teleport(World& world, std::span<const int> cloths, std::span<const int> obstacles, const Pose& motion, bool keep) {
    turn_directions(world, {world.scene.model, cloths, obstacles}, motion);
    for (const int cloth : cloths) move_cloth(world, world.scene.model.cloths[cloth], motion, keep);
    for (const int k : obstacles) {
        ObstacleState& obstacle = world.scene.script.obstacles[k];
        obstacle.start = moved(motion, obstacle.start);
        obstacle.end = moved(motion, obstacle.end);
        obstacle.settled = false;
    }
    update_points(world.state.cloth);
    world.state.contact.forget();
    world.load_source = LoadSource::nowhere;
    world.changed = true;
    scene_changed(world);
}

}  // namespace percale
