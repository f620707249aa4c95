#include <algorithm>
#include <memory>

#include "percale/options.h"
#include "simulation_implementation.h"
#include "step/sewing.h"
#include "step/teleport.h"

namespace percale {

void Simulation::pin(ClothId cloth, int vertex) {
    World& world = implementation_->world;
    const int at = implementation_->vertex(cloth, vertex);
    world.scene.script.free[at] = 0.0;
    world.scene.script.pin_targets.set(at, world.state.cloth.positions.at(at));
    world.state.cloth.velocities.set(at, Vec3::Zero());
    scene_changed(world);
}

void Simulation::unpin(ClothId cloth, int vertex) {
    World& world = implementation_->world;
    world.scene.script.free[implementation_->pinned_vertex(cloth, vertex, "unpin")] = 1.0;
    scene_changed(world);
}

void Simulation::move_pin(ClothId cloth, int vertex, const Vec3& target) {
    const int at = implementation_->pinned_vertex(cloth, vertex, "move_pin");
    check_finite(target, implementation_->cloth(cloth).name + ": the target of pinned vertex " + std::to_string(vertex));
    World& world = implementation_->world;
    if (target != world.state.cloth.positions.at(at)) wake(world.rest);
    world.scene.script.pin_targets.set(at, target);
    if (std::ranges::find(world.refused.vertices, at) == world.refused.vertices.end()) return;
    world.state.cloth.positions.set(at, target);  // no step starts from the refused place
    world.state.past.forget();
    world.load_source = LoadSource::nowhere;
    update_points(world.state.cloth);
    implementation_->forget_previous(implementation_->cloth(cloth));
    implementation_->update_views();
}

void Simulation::move_obstacle(ObstacleId obstacle, const Pose& end) {
    ObstacleState& state = implementation_->obstacle(obstacle);
    check_pose(end, state.name);
    if (end.scale != state.start.scale) {
        throw SceneError(state.name, "the scale of an obstacle cannot change, it is " + number_text(state.start.scale));
    }
    state.end = normalised(end);
    if (state.end != state.start) wake(implementation_->world.rest);
    if (implementation_->world.refused.obstacle != implementation_->index(obstacle)) return;
    state.start = state.end;  // no step starts from the refused place
    state.settled = false;
}

void Simulation::deform_obstacle(ObstacleId obstacle, std::span<const Vec3> end) {
    ObstacleState& state = implementation_->obstacle(obstacle);
    if (!state.start_shape) throw SceneError(state.name, "is rigid; to move its vertices add it with deforming = true");
    if (end.size() != state.start_shape->size()) {
        throw SceneError(state.name, std::to_string(end.size()) + " positions for the " +
                                         std::to_string(state.start_shape->size()) + " vertices of its mesh");
    }
    check_all_finite(end, state.name + ": vertex ");
    World& world = implementation_->world;
    try {  // at once, so that no step throws
        world.scene.detector->deform_obstacle(implementation_->index(obstacle), *state.start_shape, end);
    } catch (const SceneError& error) {
        throw SceneError(state.name, error.what());
    }
    state.aim_at(std::make_shared<const std::vector<Vec3>>(end.begin(), end.end()));
    if (state.deforms()) wake(world.rest);
    if (world.refused.obstacle != implementation_->index(obstacle)) return;
    if (state.deforms()) state.reach = state.end_reach;
    state.start_shape = state.end_shape;  // no step starts from the refused place
    state.compliance.deflection.clear();
    state.shape_travel = 0.0;
    state.settled = false;
}

void Simulation::set_gravity(const Vec3& gravity) {
    StepSettings settings = implementation_->world.scene.settings;
    settings.gravity = gravity;
    check_options(settings, "set_gravity");
    implementation_->change(settings);
}

void Simulation::set_wind(const Vec3& velocity) {
    StepSettings settings = implementation_->world.scene.settings;
    settings.wind = velocity;
    check_options(settings, "set_wind");
    implementation_->change(settings);
}

SeamId Simulation::add_seam(ClothId first, ClothId second, std::span<const Stitch> stitches, const SeamSettings& settings) {
    World& world = implementation_->world;
    check_range(settings.name, "after", "s", settings.after, 0.0, 1e6);
    check_range(settings.name, "over", "s", settings.over, 0.0, 1e6);
    check_range(settings.name, "stiffness", "N/m", settings.stiffness, 1e-3, 1e9);
    std::vector<Stitch> sewn;
    for (const Stitch& stitch : stitches) {
        check_range(settings.name, "the share of a stitch", "", stitch.share, 0.0, 1.0);
        sewn.push_back({implementation_->vertex(first, stitch.vertex), implementation_->vertex(second, stitch.from),
                        implementation_->vertex(second, stitch.to), stitch.share});
        if (!joins_itself(sewn.back())) continue;
        throw SceneError(settings.name, "vertex " + std::to_string(stitch.vertex) + " of " + implementation_->cloth(first).name +
                                            " is sewn to itself");
    }
    if (sewn.empty()) throw SceneError(settings.name, "no vertices, a seam joins at least one pair");
    sew(world, sewn, settings);
    return {world.seam_numbers.give()};
}

SeamId Simulation::add_seam(ClothId first, ClothId second, std::span<const std::array<int, 2>> vertices,
                            const SeamSettings& settings) {
    std::vector<Stitch> stitches;
    for (const auto& [one, other] : vertices) stitches.push_back({one, other, other, 0.0});
    return add_seam(first, second, stitches, settings);
}

void Simulation::set_pair(ClothId first, ClothId second, const ClothPair& pair) {
    World& world = implementation_->world;
    const std::string names = implementation_->cloth(first).name + " and " + implementation_->cloth(second).name;
    for (const ClothId id : {first, second}) {
        const ClothRange& cloth = implementation_->cloth(id);
        if (!cloth.fabric.self_contact)
            throw SceneError(names, cloth.name + " meets no cloth, its fabric has self_contact = false");
    }
    if (pair.thickness && !pair.contact) throw SceneError(names, "without contact a thickness says nothing");
    if (pair.thickness) check_range(names, "thickness", "m", *pair.thickness, 1e-6, 1.0);
    world.scene.script.pairs.set(implementation_->index(first), implementation_->index(second), pair);
    pass_cloth_to_detector(world);
    world.changed = true;
    scene_changed(world);
}

void Simulation::set_layer(ClothId cloth, int layer) {
    World& world = implementation_->world;
    const ClothRange& range = implementation_->cloth(cloth);
    check_range(range.name, "layer", "", layer, -1000.0, 1000.0);
    if (!range.fabric.self_contact) throw SceneError(range.name, "a layer says nothing where it meets no cloth (self_contact)");
    world.scene.script.pairs.set_layer(implementation_->index(cloth), layer);
    pass_cloth_to_detector(world);
    world.changed = true;
}

bool Simulation::meets(ClothId first, ClothId second) const {
    return meet_now(implementation_->world, implementation_->index(first), implementation_->index(second));
}

std::vector<double> Simulation::seam_gaps(SeamId seam) const {
    const World& world = implementation_->world;
    std::vector<double> gaps;
    for (const Stitch& stitch : world.scene.script.seams[implementation_->index(seam)].stitches)
        gaps.push_back(stitch_gap(stitch, world.state.cloth.positions).norm());
    return gaps;
}

void Simulation::set_time_step(double time_step) {
    StepSettings settings = implementation_->world.scene.settings;
    settings.time_step = time_step;
    check_options(settings, "set_time_step");
    implementation_->change(settings);
}

void Simulation::set_work_limit(int iterations) {
    StepSettings settings = implementation_->world.scene.settings;
    settings.work_limit = iterations;
    check_options(settings, "set_work_limit");
    implementation_->world.scene.settings = settings;
}

void Simulation::set_time_limit(double seconds) {
    if (seconds != 0.0) check_range("set_time_limit", "seconds", "s", seconds, 1e-6, 1e6);
    implementation_->world.time_limit = seconds;
}

void Simulation::set_cancel(const std::atomic<bool>* cancel) {
    implementation_->world.cancel = cancel;
    if (implementation_->world.scene.detector) implementation_->world.scene.detector->set_cancel(cancel);
}

void Simulation::set_positions(ClothId cloth, std::span<const Vec3> positions) {
    World& world = implementation_->world;
    const ClothRange& range = implementation_->cloth(cloth);
    implementation_->check_size(range, positions.size(), "set_positions", "positions");
    check_all_finite(positions, range.name + ": position ");
    for (int i = 0; i < range.count; ++i) {
        world.state.cloth.positions.set(range.index_of(i), positions[i]);
        world.scene.script.pin_targets.set(range.index_of(i), positions[i]);
    }
    implementation_->was_placed(range);
}

void Simulation::teleport(std::span<const ClothId> cloths, std::span<const ObstacleId> obstacles, const Pose& motion,
                          TeleportVelocities velocities) {
    check_pose(motion, "teleport");
    if (motion.scale != 1.0) throw SceneError("teleport", "scale = " + number_text(motion.scale) + ", a rigid motion has 1");
    std::vector<int> cloth_indices, obstacle_indices;
    for (const ClothId id : cloths) {
        const int index = implementation_->index(id);
        if (std::ranges::count(cloth_indices, index) == 0) cloth_indices.push_back(index);
    }
    for (const ObstacleId id : obstacles) {
        const int index = implementation_->index(id);
        if (std::ranges::count(obstacle_indices, index) == 0) obstacle_indices.push_back(index);
    }
    percale::teleport(implementation_->world, cloth_indices, obstacle_indices, normalised(motion),
                      velocities == TeleportVelocities::keep);
    for (const int cloth : cloth_indices) implementation_->forget_previous(implementation_->world.scene.model.cloths[cloth]);
    implementation_->update_views();
}

void Simulation::set_velocities(ClothId cloth, std::span<const Vec3> velocities) {
    World& world = implementation_->world;
    const ClothRange& range = implementation_->cloth(cloth);
    implementation_->check_size(range, velocities.size(), "set_velocities", "velocities");
    check_all_finite(velocities, range.name + ": velocity ");
    for (int i = 0; i < range.count; ++i) {
        const bool free = world.scene.script.free[range.index_of(i)] > 0.0;
        world.state.cloth.velocities.set(range.index_of(i), free ? velocities[i] : Vec3(Vec3::Zero()));
    }
    std::erase_if(world.state.cloth.impacts, [&](const Impact& impact) {
        return impact.vertex >= range.first && impact.vertex < range.first + range.count;
    });
    world.state.past.forget();
    wake(world.rest);
}

}  // namespace percale
