#include "failure.h"

#include <algorithm>
#include <limits>

#include "tolerances.h"

namespace percale {
namespace {

/// Strain of held cloth from which the report of a step that failed, or did not converge, names the cloth.
constexpr double reported_strain = 1.0;

/// Names a pin that is blocked, or blocks.
void name_vertex(const StepScene& scene, int vertex, StepReport& report) {
    report.blocked_cloth = cloth_of(scene.model, vertex);
    const ClothRange& cloth = scene.model.cloths[report.blocked_cloth];
    report.blocked_vertex = cloth.user_vertex(vertex);
    report.blocked_name = cloth.name;
}

/// Names the pin that is farthest from where it should be.
void name_blocked_pin(const StepScene& scene, const Workspace& work, StepReport& report) {
    double farthest = 0.0;
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) continue;
        const double missing = (work.newton.current.positions.at(i) - work.targets.at(i)).norm();
        if (missing <= farthest) continue;
        farthest = missing;
        name_vertex(scene, i, report);
    }
}

/// Whether two contacts press one vertex of cloth from opposite sides.
bool press_from_both_sides(const ContactConstraints& constraints, std::size_t one, std::size_t other) {
    if (constraints.obstacle[other] < 0 || constraints.direction[one].dot(constraints.direction[other]) > opposite_sides)
        return false;
    const auto holds = [&](int vertex) { return vertex >= 0 && std::ranges::count(constraints.vertex[other], vertex) > 0; };
    return std::ranges::any_of(constraints.vertex[one], holds);
}

/// Names the closest of the contacts with other obstacles that push against the closest one's direction; without one the same
/// obstacle, if it presses cloth from both sides.
void name_second_obstacle(const StepScene& scene, const ContactConstraints& constraints, std::size_t closest,
                          StepReport& report) {
    double min = std::numeric_limits<double>::infinity();
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        const bool other =
            constraints.obstacle[constraint] >= 0 && constraints.obstacle[constraint] != constraints.obstacle[closest];
        if (!other || constraints.direction[constraint].dot(constraints.direction[closest]) >= 0.0 ||
            constraints.distance[constraint] >= min)
            continue;
        min = constraints.distance[constraint];
        report.second_obstacle = constraints.obstacle[constraint];
    }
    for (std::size_t constraint = 0; constraint < constraints.size() && report.second_obstacle < 0; ++constraint) {
        if (press_from_both_sides(constraints, closest, constraint)) report.second_obstacle = constraints.obstacle[constraint];
    }
    if (report.second_obstacle >= 0) report.second_name = scene.script.obstacles[report.second_obstacle].name;
}

/// Names the held vertex of a contact: a pinned vertex, which cannot get out of the way.
void name_held_vertex(const StepScene& scene, const std::array<int, 4>& vertices, StepReport& report) {
    for (const int i : vertices) {
        if (i < 0 || scene.is_free(i)) continue;
        report.blocked_by_pin = true;
        return name_vertex(scene, i, report);
    }
}

/// Names the obstacle of the closest contact.
void name_blocking_obstacle(const StepScene& scene, const ContactConstraints& constraints, StepReport& report) {
    if (constraints.size() == 0) return;
    const auto closest =
        std::min_element(constraints.distance.begin(), constraints.distance.end()) - constraints.distance.begin();
    report.blocking_obstacle = constraints.obstacle[static_cast<std::size_t>(closest)];
    const bool cloth = report.blocking_obstacle < 0;
    report.blocking_name = cloth ? "cloth" : scene.script.obstacles[report.blocking_obstacle].name;
    name_second_obstacle(scene, constraints, static_cast<std::size_t>(closest), report);
    if (!scene.plan.pins_move) name_held_vertex(scene, constraints.vertex[static_cast<std::size_t>(closest)], report);
}

/// Names the cloth whose edges are stretched the furthest between its fixed pins and a moving body, if to more than twice their
/// length.
void name_stretched_cloth(const StepScene& scene, const Workspace& work, StepReport& report) {
    const SpringNetwork& springs = scene.model.springs;
    const Vec3Arrays& positions = work.newton.current.positions;
    std::vector<int> pins(scene.model.cloths.size(), 0);
    for (std::size_t c = 0; c < pins.size(); ++c) {
        const ClothRange& cloth = scene.model.cloths[c];
        for (int i = cloth.first; i < cloth.first + cloth.count; ++i) pins[c] += scene.is_free(i) ? 0 : 1;
    }
    for (int k = 0; k < springs.size(); ++k) {
        if (springs.kind[k] != SpringKind::structural) continue;
        const double length = (positions.at(springs.first[k]) - positions.at(springs.second[k])).norm();
        const double strain = length / springs.rest_length[k] - 1.0;
        if (!(strain > std::max(report.stretch, reported_strain))) continue;
        const int c = cloth_of(scene.model, springs.first[k]);
        if (pins[c] == 0) continue;
        report.stretch = strain;
        report.stretched_cloth = c;
        report.stretched_name = scene.model.cloths[c].name;
        report.stretched_pins = pins[c];
    }
}

}  // namespace

void report_failure(const StepScene& scene, SubstepOutcome end, const Workspace& work, StepReport& report) {
    if (end == SubstepOutcome::not_finite) {
        report.status = StepStatus::not_finite;
        return;
    }
    name_blocking_obstacle(scene, work.newton.current.constraints, report);
    if (scene.plan.pins_move) name_blocked_pin(scene, work, report);
    if (!scene.plan.pins_move) name_stretched_cloth(scene, work, report);
    report.status = scene.plan.obstacles_move ? StepStatus::obstacle_too_fast : StepStatus::pin_blocked;
}

void report_unsolved(const StepScene& scene, const Workspace& work, StepReport& report) {
    report.status = StepStatus::not_converged;
    if (!scene.plan.pins_move) name_stretched_cloth(scene, work, report);
}

void report_too_far(const StepScene& scene, const MotionParts& motion, StepReport& report) {
    report.travel = motion.travel;
    if (motion.vertex >= 0) {
        report.status = StepStatus::pin_blocked;
        name_vertex(scene, motion.vertex, report);
        return;
    }
    report.status = StepStatus::obstacle_too_fast;
    report.blocking_obstacle = motion.obstacle;
    report.blocking_name = scene.script.obstacles[motion.obstacle].name;
}

}  // namespace percale
