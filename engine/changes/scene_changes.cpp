#include "scene_changes.h"

#include <algorithm>
#include <tuple>

namespace percale {
namespace {

/// Numbers above `removed` decrease by one; -1: the removed number itself, or none.
int without(int number, int removed) { return number == removed ? -1 : number > removed ? number - 1 : number; }

/// Renumbers all entries with a vertex and an obstacle by `vertex` and `obstacle`, which return the new number, -1: removed.
/// Entries that refer to cloth instead of an obstacle (-1) keep that.
template <class Held, class VertexNumber, class ObstacleNumber>
void renumber(std::vector<Held>& list, VertexNumber vertex, ObstacleNumber obstacle) {
    std::vector<Held> left;
    for (Held held : list) {
        const bool of_obstacle = held.obstacle >= 0;
        held.vertex = vertex(held.vertex);
        if (of_obstacle) held.obstacle = obstacle(held.obstacle);
        if (held.vertex >= 0 && (!of_obstacle || held.obstacle >= 0)) left.push_back(held);
    }
    list = std::move(left);
    std::ranges::sort(list, {}, [](const Held& held) { return std::tuple(held.vertex, held.obstacle); });
}

template <class VertexNumber, class ObstacleNumber>
void renumber(ContactMultipliers& forces, VertexNumber vertex, ObstacleNumber obstacle) {
    std::vector<KeyedForce> left;
    for (KeyedForce force : forces.all()) {
        bool there = true;
        for (int& each : force.key.vertex) {
            if (each < 0) continue;
            each = vertex(each);
            there = there && each >= 0;
        }
        if (force.key.obstacle >= 0) {
            force.key.obstacle = obstacle(force.key.obstacle);
            there = there && force.key.obstacle >= 0;
        }
        if (there) left.push_back(force);
    }
    forces.clear(left.size());
    forces.set(left);
}

/// The same for entries with several vertices.
template <class VertexNumber>
void renumber(std::vector<ClothAnchor>& anchors, VertexNumber vertex) {
    std::vector<ClothAnchor> left;
    for (ClothAnchor anchor : anchors) {
        bool there = true;
        for (int& each : anchor.vertex) {
            if (each < 0) continue;
            each = vertex(each);
            there = there && each >= 0;
        }
        if (there) left.push_back(anchor);
    }
    anchors = std::move(left);
}

/// Stores the contact forces of the last solve, as its constraints keep their old numbers.
void note_loads(World& world) {
    world.saved_loads = contact_loads(world);
    if (world.load_source != LoadSource::nowhere) world.load_source = LoadSource::saved_state;
}

/// Renumbers all contact data of a world, its loads stored first.
template <class VertexNumber, class ObstacleNumber>
void renumber_contacts(World& world, VertexNumber vertex, ObstacleNumber obstacle) {
    renumber(world.saved_loads, vertex, obstacle);
    renumber(world.state.cloth.stick_anchors, vertex, obstacle);
    renumber(world.state.cloth.impacts, vertex, obstacle);
    renumber(world.state.contact.last, vertex, obstacle);
    renumber(world.state.contact.lasting, vertex, obstacle);
    renumber(world.state.contact.cloth_anchors, vertex);
    if (world.refused.obstacle >= 0) world.refused.obstacle = obstacle(world.refused.obstacle);
    for (int& each : world.refused.vertices) each = vertex(each);
    std::erase(world.refused.vertices, -1);
}

/// Copies positions, velocities and pins of the remaining cloth; no cloth is new here.
void carry_over(const std::vector<int>& number, World& world) {
    const int count = world.scene.model.vertex_count();
    const ClothState& before = world.state.cloth;
    ClothState state;
    for (auto* vectors : {&state.positions, &state.velocities}) vectors->resize(count);
    state.points.resize(count);
    Vec3Arrays targets = state.positions;
    AlignedVector<double> free(targets.padded_size(), 0.0);
    for (std::size_t i = 0; i < number.size(); ++i) {
        const int from = static_cast<int>(i), to = number[i];
        if (to < 0) continue;
        state.positions.set(to, before.positions.at(from));
        state.velocities.set(to, before.velocities.at(from));
        targets.set(to, world.scene.script.pin_targets.at(from));
        free[to] = world.scene.script.free[from];
    }
    state.stick_anchors = before.stick_anchors;
    state.impacts = before.impacts;
    update_points(state);
    if (!before.rest_length.empty() && !world.scene.script.seams.empty()) {
        state.rest_length = world.scene.model.springs.rest_length;
        for (const Seam& seam : world.scene.script.seams) set_seam_lengths(seam, world.state.time, state.rest_length);
    }
    world.state.cloth = std::move(state);
    world.scene.script.free = std::move(free);
    world.scene.script.pin_targets = std::move(targets);
}

/// Whether an obstacle touches cloth; loads are stored.
bool touches(const World& world, int obstacle) {
    const auto with_it = [&](const auto& held) { return held.obstacle == obstacle; };
    const auto force_with_it = [&](const KeyedForce& force) { return force.key.obstacle == obstacle; };
    const ClothState& cloth = world.state.cloth;
    const ContactWarmStart& contact = world.state.contact;
    return std::ranges::any_of(cloth.stick_anchors, with_it) || std::ranges::any_of(cloth.impacts, with_it) ||
           std::ranges::any_of(contact.last.all(), force_with_it) || std::ranges::any_of(contact.lasting.all(), force_with_it) ||
           std::ranges::any_of(world.saved_loads, with_it);
}

/// Whether a detector receives different data for the two fabrics on the same mesh, or a valid start of one may be invalid for
/// the other.
bool meets_otherwise(const Fabric& a, const Fabric& b) {
    return a.thickness != b.thickness || a.self_contact != b.self_contact || a.friction != b.friction ||
           a.strain_limit.has_value() != b.strain_limit.has_value();
}

/// Replaces the model of the world by one made anew from it: the remaining cloth keeps state, pins and contact, under its new
/// numbers. The caller updates the detector.
void adopt_model(RemadeModel&& made, World& world) {
    note_loads(world);
    renumber_contacts(
        world, [&](int vertex) { return made.vertex[vertex]; }, [](int obstacle) { return obstacle; });
    world.scene.model = std::move(made.model);
    world.scene.script.seams = std::move(made.seams);
    carry_over(made.vertex, world);
    world.work = Workspace{};
    world.holds_before = {};
    world.waiting = waiting_cloth(world.scene, world.state.time);
    set_workers(world);
    scene_changed(world);
}

/// Throws SceneError where the detector cannot handle contact between cloths: it receives an empty list, and later all cloth
/// anew.
void check_knows_cloth(World& world) {
    const std::size_t count = world.scene.model.rest.size();
    const std::vector<int> nowhere(count, -1);
    const std::vector<double> friction(count, 0.0);
    world.scene.detector->set_self_contact(
        {.cloth = nowhere, .rest = world.scene.model.rest, .friction = friction, .stitches = {}});
}

}  // namespace

std::vector<int> drop_cloth(World& world, int cloth) {
    RemadeModel made = remake(world.scene.model, world.scene.script.seams, {.cloth = cloth});
    std::vector<int> seams_left = std::move(made.seam_before);
    adopt_model(std::move(made), world);
    const ClothPairs before = std::move(world.scene.script.pairs);
    ClothPairs& pairs = world.scene.script.pairs = {};
    for (const auto& [cloths, pair] : before.said()) {
        const int first = without(cloths[0], cloth), second = without(cloths[1], cloth);
        if (first >= 0 && second >= 0) pairs.set(first, second, pair);
    }
    for (const auto& [number, layer] : before.layers()) {
        if (number != cloth) pairs.set_layer(without(number, cloth), layer);
    }
    pass_cloth_to_detector(world);
    return seams_left;
}

void change_fabric(World& world, int cloth, const Fabric& fabric) {
    const ClothRange before = world.scene.model.cloths[cloth];
    RemadeModel made = remake(world.scene.model, world.scene.script.seams, {cloth, &fabric});
    // All refusals precede any change.
    if (fabric.self_contact && !meets_cloth(world.scene)) check_knows_cloth(world);
    adopt_model(std::move(made), world);
    const bool same_order = before.order.place == world.scene.model.cloths[cloth].order.place;
    if (same_order && !meets_otherwise(before.fabric, fabric)) return;
    world.changed = true;
    pass_cloth_to_detector(world);
}

void drop_obstacle(World& world, int obstacle) {
    world.scene.detector->remove_obstacle(obstacle);
    note_loads(world);
    const bool touched = touches(world, obstacle);
    renumber_contacts(
        world, [](int vertex) { return vertex; }, [&](int number) { return without(number, obstacle); });
    world.scene.script.obstacles.erase(world.scene.script.obstacles.begin() + obstacle);
    std::vector<ObstacleImpulse>& impulses = world.state.impulses;
    if (static_cast<std::size_t>(obstacle) < impulses.size()) impulses.erase(impulses.begin() + obstacle);
    world.plan_outdated = true;
    if (touched) scene_changed(world);
}

}  // namespace percale
