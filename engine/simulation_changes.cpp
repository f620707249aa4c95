#include <algorithm>

#include "changes/scene_changes.h"
#include "simulation_implementation.h"

namespace percale {

void Simulation::remove_cloth(ClothId cloth) {
    World& world = implementation_->world;
    const int index = implementation_->index(cloth);
    const ClothRange& range = world.scene.model.cloths[index];
    const std::size_t first = range.first, last = first + range.count;
    std::vector<Vec3>& previous = implementation_->previous;
    if (previous.size() >= last)
        previous.erase(previous.begin() + static_cast<long>(first), previous.begin() + static_cast<long>(last));
    const std::vector<int> seams_left = drop_cloth(world, index);
    world.cloth_numbers.take_out(index);
    std::vector<int> numbers;
    for (const int seam : seams_left) numbers.push_back(world.seam_numbers.all[seam]);
    world.seam_numbers.all = std::move(numbers);
    std::erase_if(implementation_->start_moves, [&](const StartMove& move) { return move.cloth == cloth.index; });
    implementation_->renew_views();
}

void Simulation::remove_obstacle(ObstacleId obstacle) {
    World& world = implementation_->world;
    const int index = implementation_->index(obstacle);
    try {
        drop_obstacle(world, index);
    } catch (const SceneError& error) {
        throw SceneError(world.scene.script.obstacles[index].name, error.what());
    }
    world.obstacle_numbers.take_out(index);
    std::erase_if(implementation_->start_moves, [&](const StartMove& move) { return move.obstacle == obstacle.index; });
}

void Simulation::set_fabric(ClothId cloth, const Fabric& fabric) {
    World& world = implementation_->world;
    const int index = implementation_->index(cloth);
    const ClothRange before = world.scene.model.cloths[index];
    if (fabric.self_contact) implementation_->check_meets(before.name);
    std::vector<Vec3>& previous = implementation_->previous;
    const std::vector<Vec3> earlier = previous;
    change_fabric(world, index, fabric);
    const ClothRange& now = world.scene.model.cloths[index];
    for (int i = 0; i < now.count && static_cast<std::size_t>(before.first + before.count) <= earlier.size(); ++i)
        previous[now.index_of(i)] = earlier[before.index_of(i)];
    implementation_->renew_views();
}

void Simulation::set_friction(ObstacleId obstacle, double friction) {
    ObstacleState& state = implementation_->obstacle(obstacle);
    check_friction(state.name, friction);
    if (friction == state.friction) return;
    World& world = implementation_->world;
    try {
        world.scene.detector->set_friction(implementation_->index(obstacle), friction);
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

void Simulation::keep_impulses(bool keep) {
    implementation_->world.keeps_impulses = keep;
    if (!keep) implementation_->world.state.impulses = {};
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
