#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "forces/springs.h"
#include "percale/error.h"
#include "percale/simulation.h"
#include "start/start_check.h"
#include "state/saved_world.h"
#include "step/measure.h"
#include "step/step.h"

// What the sources of Simulation share: simulation_scene.cpp (bodies, steps, saved states), simulation_script.cpp (what the
// caller prescribes), simulation_changes.cpp (changes during a run) and simulation_views.cpp (views of the state).
namespace percale {

/// m or m/s: largest positions and velocities that a program may give. Larger: squares lose all digits, or are infinite.
inline constexpr double largest_given_number = 1e9;

/// |q| - 1 of a rotation that a user gives. Smaller: rotations read from text with six digits are refused. Larger: a quaternion
/// that was never meant to be a rotation is accepted.
inline constexpr double unit_length_error = 1e-6;

inline std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

inline void check_pose(const Pose& pose, const std::string& name) {
    const Rotation& q = pose.rotation;
    const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!pose.translation.allFinite()) throw SceneError(name, "the translation of its pose is not finite");
    if (!(std::abs(norm - 1.0) <= unit_length_error)) {
        throw SceneError(
            name, "the rotation of its pose has length " + number_text(norm) + ", a rotation is a unit quaternion (w, x, y, z)");
    }
    if (!(pose.scale > 0.0) || !std::isfinite(pose.scale)) {
        throw SceneError(name, "the scale of its pose is " + number_text(pose.scale) + ", it must be above 0");
    }
}

/// Exactly unit length, so that rotated lengths keep to rounding.
inline Pose normalised(Pose pose) {
    Rotation& q = pose.rotation;
    const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (norm != 1.0) q = {q.w / norm, q.x / norm, q.y / norm, q.z / norm};
    return pose;
}

inline void check_range(const std::string& owner, const std::string& what, const std::string& unit, double value, double lowest,
                        double highest) {
    if (value >= lowest && value <= highest) return;
    throw SceneError(owner, what + " = " + number_text(value) + (unit.empty() ? "" : " ") + unit +
                                " is outside the allowed range " + number_text(lowest) + " ... " + number_text(highest));
}

inline void check_finite(const Vec3& value, const std::string& what) {
    if (!value.allFinite()) throw SceneError(what + " is not finite");
}

/// `what` is followed by the number of the value.
inline void check_all_finite(std::span<const Vec3> values, const std::string& what) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!values[i].allFinite()) check_finite(values[i], what + std::to_string(i));
        if (values[i].cwiseAbs().maxCoeff() > largest_given_number)
            throw SceneError(what + std::to_string(i) + " is outside the allowed range -1e9 ... 1e9");
    }
}

inline void check_friction(const std::string& owner, double friction) {
    if (friction >= 0.0 && friction <= 10.0) return;
    throw SceneError(owner, "friction = " + number_text(friction) + " is outside the allowed range 0 ... 10");
}

struct Simulation::Implementation {
    World world;
    std::vector<StartMove> start_moves;  // with the caller's numbers
    bool keeps_previous = false;
    std::vector<Vec3> previous;  // m, of each vertex before the last step; vertices beyond its end are where they are now
    SavedSize saved_size;

    /// Index of a body among those of its kind.
    static int index_of(const GivenNumbers& numbers, int number, const std::string& kind) {
        const int index = numbers.index_of(number);
        if (index >= 0) return index;
        if (number >= 0 && number < numbers.next) throw SceneError(kind + " " + std::to_string(number) + " was removed");
        throw SceneError("there is no " + kind + " " + std::to_string(number) + ", " + kind + "s are 0 ... " +
                         std::to_string(numbers.next - 1));
    }
    int index(ClothId id) const { return index_of(world.cloth_numbers, id.index, "cloth"); }
    int index(ObstacleId id) const { return index_of(world.obstacle_numbers, id.index, "obstacle"); }
    int index(SeamId id) const { return index_of(world.seam_numbers, id.index, "seam"); }

    const ClothRange& cloth(ClothId id) const { return world.scene.model.cloths[index(id)]; }
    ObstacleState& obstacle(ObstacleId id) { return world.scene.script.obstacles[index(id)]; }

    /// The caller's number for an internal index of a cloth; -1 stays.
    int cloth_number(int index) const { return index < 0 ? index : world.cloth_numbers.all[index]; }
    int obstacle_number(int index) const { return index < 0 ? index : world.obstacle_numbers.all[index]; }
    void report_numbers(StepReport& report) const {
        for (int* cloth : {&report.blocked_cloth, &report.stretched_cloth}) *cloth = cloth_number(*cloth);
        for (int* obstacle : {&report.blocking_obstacle, &report.second_obstacle, &report.pinching[0], &report.pinching[1]})
            *obstacle = obstacle_number(*obstacle);
    }
    void report_numbers(std::vector<StartMove>& moves) const {
        for (StartMove& move : moves) {
            move.cloth = cloth_number(move.cloth);
            move.obstacle = obstacle_number(move.obstacle);
        }
    }
    /// Calls clear_start, with the caller's numbers in its result and in its exceptions.
    std::vector<StartMove> cleared_start(const char* verb) {
        try {
            std::vector<StartMove> moves = clear_start(world, verb);
            report_numbers(moves);
            return moves;
        } catch (const StartError& error) {
            StartFault fault = error.fault();
            fault.obstacle = obstacle_number(fault.obstacle);
            throw StartError(error.what(), fault);
        }
    }
    /// The same moves as saved states hold them, with internal numbers.
    std::vector<StartMove> moves_inside() const {
        std::vector<StartMove> moves = start_moves;
        for (StartMove& move : moves) {
            move.cloth = world.cloth_numbers.index_of(move.cloth);
            if (move.obstacle >= 0) move.obstacle = world.obstacle_numbers.index_of(move.obstacle);
        }
        return moves;
    }

    int vertex(ClothId id, int index) const {
        const ClothRange& range = cloth(id);
        if (index >= 0 && index < range.count) return range.index_of(index);
        throw SceneError(range.name, "there is no vertex " + std::to_string(index) + ", vertices are 0 ... " +
                                         std::to_string(range.count - 1));
    }

    int pinned_vertex(ClothId id, int index, const char* call) const {
        const int at = vertex(id, index);
        if (world.scene.script.free[at] == 0.0) return at;
        throw SceneError(cloth(id).name, std::string(call) + " of vertex " + std::to_string(index) + ", which is not pinned");
    }

    ObstacleImpulse impulse(const char* call, ObstacleId id) const {
        const auto at = static_cast<std::size_t>(index(id));
        if (!world.keeps_impulses) {
            throw SceneError(world.scene.script.obstacles[at].name,
                             std::string(call) + ": no impulses are kept, call keep_impulses before the step");
        }
        return at < world.state.impulses.size() ? world.state.impulses[at] : ObstacleImpulse{};
    }

    /// Throws unless the cloth has self_contact.
    void check_meets(const std::string& name) const {
        if (!world.scene.detector) throw SceneError(name, "self_contact needs a contact detector, give one to the simulation");
    }

    /// Throws unless `what` has `size` entries.
    void check_size(const ClothRange& range, std::size_t size, const char* call, const char* what) const {
        if (static_cast<int>(size) == range.count) return;
        throw SceneError(range.name, std::string(call) + " got " + std::to_string(size) + " " + what + " for " +
                                         std::to_string(range.count) + " vertices");
    }

    /// To be called after the vertices of a cloth were placed elsewhere in no time.
    void was_placed(const ClothRange& range) {
        const auto is_of_cloth = [&](const auto& held) {
            return held.vertex >= range.first && held.vertex < range.first + range.count;
        };
        std::erase_if(world.state.cloth.stick_anchors, is_of_cloth);
        std::erase_if(world.state.cloth.impacts, is_of_cloth);
        update_points(world.state.cloth);
        forget_previous(range);
        update_views();
        world.load_source = LoadSource::nowhere;
        world.state.contact_energy = 0.0;  // known again after the next step
        world.state.past.forget();
        world.changed = true;
        wake(world.rest);
    }

    /// The cloth has no displacement in the last step.
    void forget_previous(const ClothRange& range) {
        const std::size_t end = std::min(previous.size(), static_cast<std::size_t>(range.first + range.count));
        for (std::size_t i = range.first; i < end; ++i) previous[i] = world.state.cloth.points[i];
    }

    void change(const StepSettings& settings) {
        const bool same_air = settings.wind == world.scene.settings.wind,
                   same_gravity = settings.gravity == world.scene.settings.gravity;
        if (!same_air || !same_gravity || settings.time_step != world.scene.settings.time_step) scene_changed(world);
        world.scene.settings = settings;
    }

    std::vector<std::byte> save() { return saved_world(world, moves_inside(), saved_size); }

    /// Simulation::save, or nothing where the detector cannot save its state.
    std::vector<std::byte> saved_if_possible() {
        try {
            return save();
        } catch (const SceneError&) {
            return {};
        }
    }

    /// Sets what was measured in a step whose seams closed, and whose cloth was then moved, to the state as it is now. The
    /// energy that moving gave is work. `before`: the energy until then, J.
    void report_moves_of(double before, StepReport& report) const {
        if (!world.scene.plan.measures) return;
        const StepEnergy now = energy_of(world.scene, world.state);
        report.energy.work += now.total() - before;
        set_stored_energy(now, report.energy);
        report.largest_strain = percale::largest_strain(world.scene.model.springs, world.state.cloth.positions);
        report.largest_speed = percale::largest_speed(world.state.cloth.velocities, world.scene.model.vertex_count());
    }

    /// Brings the view of positions up to date.
    void update_views() {
        for (const ClothRange& range : world.scene.model.cloths) {
            if (range.order.kept()) continue;
            world.views.positions.resize(world.state.cloth.points.size());
            for (int i = 0; i < range.count; ++i) {
                world.views.positions[range.first + i] = world.state.cloth.points[range.index_of(i)];
            }
        }
    }

    /// All views, after vertices got other numbers.
    void renew_views() {
        world.views = {};
        update_views();
        for (const ClothRange& range : world.scene.model.cloths) add_masses(range);
    }

    /// The view of masses, after a cloth was added.
    void add_masses(const ClothRange& range) {
        if (range.order.kept()) return;
        world.views.masses.resize(world.scene.model.mass.size());
        for (int i = 0; i < range.count; ++i) world.views.masses[range.first + i] = world.scene.model.mass[range.index_of(i)];
    }
};

}  // namespace percale
