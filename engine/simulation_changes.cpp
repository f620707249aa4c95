#include "simulation_implementation.h"

namespace percale {

void Simulation::set_friction(ObstacleId obstacle, double friction) {
    ObstacleState& state = implementation_->obstacle(obstacle);
    check_friction(state.name, friction);
    if (friction == state.friction) return;
    World& world = implementation_->world;
    try {
        world.scene.detector->set_friction(obstacle.index, friction);
    } catch (const SceneError& error) {
        throw SceneError(state.name, error.what());
    }
    state.friction = friction;
    scene_changed(world);
}

void Simulation::set_restitution(ObstacleId obstacle, double restitution) {
    ObstacleState& state = implementation_->obstacle(obstacle);
    check_range(state.name, "restitution", "", restitution, 0.0, 1.0);
    if (restitution == state.restitution) return;
    state.restitution = restitution;
    scene_changed(implementation_->world);
}

void Simulation::keep_previous_positions(bool keep) {
    implementation_->keeps_previous = keep;
    if (!keep) implementation_->previous = {};
}

void Simulation::reset(ClothId cloth) {
    World& world = implementation_->world;
    const ClothRange& range = implementation_->cloth(cloth);
    ClothModel& model = world.scene.model;
    const auto is_of_cloth = [&](int vertex) { return vertex >= range.first && vertex < range.first + range.count; };
    for (int i = range.first; i < range.first + range.count; ++i) {
        world.state.cloth.positions.set(i, model.rest[i]);
        world.state.cloth.velocities.set(i, Vec3::Zero());
        world.scene.script.pin_targets.set(i, model.rest[i]);
    }
    for (LimitedEdge& edge : model.limits.edges) {
        if (is_of_cloth(model.springs.first[edge.spring])) model.limits.set_hold(edge, 0.0);
    }
    for (Weld& weld : model.welds) {
        if (is_of_cloth(weld.stitch.vertex) || is_of_cloth(weld.stitch.from)) weld.hold = Vec3::Zero();
    }
    implementation_->was_placed(range);
}

}  // namespace percale
