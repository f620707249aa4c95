#include "start_check.h"

#include <algorithm>
#include <utility>

#include "start_repair.h"
#include "step/motion.h"

namespace percale {
namespace {

/// Names of places in messages about a start.
class Names {
public:
    Names(const World& world, std::string_view verb) : world_(world), verb_(verb) {}

    std::string vertex_name(int index) const {
        const ClothRange* range = owner(index);
        if (!range) return "vertex " + std::to_string(index);
        return "vertex " + std::to_string(range->user_vertex(index)) + " of " + range->name;
    }

    /// The user's number of a vertex, counted through all cloths.
    int user_index(int index) const {
        const ClothRange* range = owner(index);
        return range ? range->first + range->user_vertex(index) : index;
    }

    std::string start_text(const StartFault& fault) const {
        if (fault.between_cloths()) return cloth_text(fault);
        const std::string& obstacle_name = world_.scene.script.obstacles[fault.obstacle].name;
        if (fault.intersecting_pairs > 0) {
            const int corner = world_.scene.model.triangles[fault.cloth_triangle][0];
            return "the cloth" + verb_ + "through " + obstacle_name + ": " + std::to_string(fault.intersecting_pairs) +
                   " intersecting triangle pairs, one of them at " + vertex_name(corner) + " and triangle " +
                   std::to_string(fault.obstacle_triangle);
        }
        if (fault.vertices_inside > 0) {
            return "the cloth" + verb_ + "inside " + obstacle_name + ": " + std::to_string(fault.vertices_inside) +
                   " vertices, one of them " + vertex_name(fault.inside_vertex);
        }
        return "the cloth" + verb_ + "touching " + obstacle_name;
    }

    /// How to correct the fault.
    std::string advice(const StartFault& fault) const {
        if (!fault.between_cloths()) return "; move the cloth or the obstacle apart";
        const bool same = cloth_triangle(fault.cloth_triangle).first == cloth_triangle(fault.other_cloth_triangle).first;
        return same ? "; move them apart, or let self_contact be false"
                    : "; move them apart, say by layers which is worn outside, or let self_contact be false";
    }

private:
    /// The cloth of a triangle of the whole system, and its index there.
    std::pair<const ClothRange*, long> cloth_triangle(int triangle) const {
        const std::vector<Triangle>& all = world_.scene.model.triangles;
        const auto owns = [&](const ClothRange& range) { return all[triangle][0] < range.first + range.count; };
        const auto owner = std::find_if(world_.scene.model.cloths.begin(), world_.scene.model.cloths.end(), owns);
        const auto first = std::find_if(all.begin(), all.end(), [&](const Triangle& t) { return t[0] >= owner->first; });
        return {&*owner, triangle - (first - all.begin())};
    }

    std::string cloth_text(const StartFault& fault) const {
        const auto [cloth, triangle] = cloth_triangle(fault.cloth_triangle);
        const auto [other, other_triangle] = cloth_triangle(fault.other_cloth_triangle);
        const bool same = cloth == other;
        const std::string places = "triangle " + std::to_string(triangle) + (same ? "" : " of " + cloth->name) +
                                   " and triangle " + std::to_string(other_triangle) + (same ? "" : " of " + other->name);
        const std::string met = same ? "itself" : other->name;
        if (fault.intersecting_pairs == 0) {
            return cloth->name + verb_ + "touching " + met + ": " + places;
        }
        return cloth->name + verb_ + "through " + met + ": " + std::to_string(fault.intersecting_pairs) +
               " intersecting triangle pairs, one of them " + places;
    }

    /// The cloth that owns a vertex of the whole system; null if there is no such vertex.
    const ClothRange* owner(int index) const {
        const ClothModel& model = world_.scene.model;
        return index >= 0 && index < model.vertex_count() ? &model.cloths[cloth_of(model, index)] : nullptr;
    }

    const World& world_;
    std::string verb_;
};

/// The first pinned vertex inside the obstacle, -1 where there is none.
int pin_inside(const World& world, const StartFault& fault) {
    const auto pinned = [&](int v) { return world.scene.script.free[v] == 0.0; };
    const auto found = std::find_if(fault.inside_vertices.begin(), fault.inside_vertices.end(), pinned);
    return found == fault.inside_vertices.end() ? -1 : *found;
}

/// Throws StartError, its vertices in the user's numbers.
[[noreturn]] void refuse_start(const Names& names, const std::string& message, StartFault fault) {
    fault.inside_vertex = names.user_index(fault.inside_vertex);
    for (int& vertex : fault.inside_vertices) vertex = names.user_index(vertex);
    std::sort(fault.inside_vertices.begin(), fault.inside_vertices.end());
    throw StartError(message, fault);
}

/// The detector may know the obstacles at the start of an earlier step only.
void place_obstacles(World& world) {
    for (std::size_t k = 0; k < world.scene.script.obstacles.size(); ++k) {
        ObstacleState& obstacle = world.scene.script.obstacles[k];
        if (obstacle.settled) continue;
        ObstacleState there = obstacle;
        there.end = there.start;
        there.end_shape = there.start_shape;
        there.pass_to(*world.scene.detector, static_cast<int>(k));
        obstacle.settled = true;
    }
}

}  // namespace

std::vector<StartMove> clear_start(World& world, std::string_view verb) {
    const Names names(world, verb);
    place_obstacles(world);
    world.refused = {};
    const StartFault fault = world.scene.detector->check_start(world.state.cloth.points);
    if (!fault.any()) return {};
    world.refused = {fault.obstacle, fault.inside_vertices};  // unless resolving penetration succeeds
    const std::string what = names.start_text(fault);
    const std::string advice = names.advice(fault);
    if (const int pin = pin_inside(world, fault); pin >= 0 && !fault.between_cloths()) {
        refuse_start(names,
                     "pinned " + names.vertex_name(pin) + " starts inside " + world.scene.script.obstacles[fault.obstacle].name +
                         "; move the pin or the obstacle, or do not pin this vertex",
                     fault);
    }
    if (world.scene.settings.start == StartRule::refuse) {
        refuse_start(names, what + advice + ", or allow start = repair", fault);
    }
    StartRepair repair = repair_start(world, fault);
    if (!repair.obstruction.empty()) {
        refuse_start(names, what + ", and " + repair.obstruction + advice, fault);
    }
    world.refused = {};
    return std::move(repair.moves);
}

}  // namespace percale
