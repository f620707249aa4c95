#pragma once

#include <cstddef>
#include <vector>

#include "percale/report.h"
#include "percale/saved_report.h"
#include "percale/saved_state.h"
#include "saved_loads.h"
#include "step/world.h"

namespace percale {

/// The state of an obstacle without its name.
struct SavedObstacle {
    Pose start, end;
    bool settled = true;
    std::vector<Vec3> start_shape, end_shape;  // empty: it is rigid; the second, too, where it is the first
    std::vector<Vec3> deflection, aim;
};

/// Contact forces by constraint, in the order of their keys.
struct SavedContact {
    std::vector<KeyedForce> last, lasting;
    std::vector<ClothAnchor> cloth_anchors;
    double energy = 0.0, min_distance = 0.0;
};

/// All of a world except its model, its settings, and what each step makes anew.
struct SavedWorld {
    bool changed = true, plan_outdated = true;
    std::vector<int> waiting;
    StepSettings settings;  // only time step, gravity and wind
    StepState state;        // without contact and points
    SavedContact contact;
    AlignedVector<double> free;
    Vec3Arrays pin_targets;
    std::vector<SavedObstacle> obstacles;
    std::vector<Seam> seams;            // without their stitches, which belong to the cloth
    std::vector<Vec3> sewn_directions;  // of the points sewn to
    Holds holds;
    std::vector<double> clamps;  // of the hinges
    StepPlan plan;
    RestState rest;
    bool solver_is_set = false;
    StepSolver::Choice solver;
    std::vector<StartMove> start_moves;
    SavedLoads loads;
    std::vector<std::byte> detector;
};

template <class Archive, OfType<Vec3Arrays> Value>
void exchange(Archive& archive, Value& vectors) {
    archive(vectors.x, vectors.y, vectors.z);
}

template <class Archive, OfType<StickAnchor> Value>
void exchange(Archive& archive, Value& stick_anchor) {
    archive(stick_anchor.vertex, stick_anchor.obstacle, stick_anchor.stretch);
}

template <class Archive, OfType<Impact> Value>
void exchange(Archive& archive, Value& impact) {
    archive(impact.vertex, impact.obstacle, impact.speed, impact.stopped);
}

template <class Archive, OfType<ClothState> Value>
void exchange(Archive& archive, Value& state) {
    archive(state.positions, state.velocities, state.stick_anchors, state.impacts, state.rest_length);
}

template <class Archive, OfType<SavedObstacle> Value>
void exchange(Archive& archive, Value& obstacle) {
    archive(obstacle.start, obstacle.end, obstacle.settled, obstacle.start_shape, obstacle.end_shape, obstacle.deflection,
            obstacle.aim);
}

template <class Archive, OfType<Seam> Value>
void exchange(Archive& archive, Value& seam) {
    archive(seam.first_spring, seam.length, seam.from, seam.over, seam.first_weld, seam.contact);
}

/// The parts of a plan that plan_again takes over.
template <class Archive, OfType<StepPlan> Value>
void exchange(Archive& archive, Value& plan) {
    archive.choice(plan.scheme, static_cast<int>(Scheme::automatic));
    archive(plan.parts, plan.obstacles_move, plan.pins_move, plan.seams_close);
}

/// The figures that a simulation asleep repeats.
template <class Archive, OfType<StepReport> Value>
void exchange(Archive& archive, Value& report) {
    archive(report.dt, report.smallest_dt, report.largest_dt, report.slept, report.sleeping_cloths, report.contacts,
            report.contact_hash, report.smallest_distance, report.contact_stiffness, report.largest_strain, report.largest_speed,
            report.energy);
}

template <class Archive, OfType<ClothRest> Value>
void exchange(Archive& archive, Value& rest) {
    archive(rest.still_time, rest.asleep);
}

template <class Archive, OfType<RestState> Value>
void exchange(Archive& archive, Value& rest) {
    archive(rest.cloths, rest.anchor, rest.potential, rest.asleep, rest.figures);
}

template <class Archive, OfType<SchemeHistory> Value>
void exchange(Archive& archive, Value& past) {
    archive(past.earlier, past.earlier_length, past.acceleration, past.unbalanced);
}

template <class Archive, OfType<StepState> Value>
void exchange(Archive& archive, Value& state) {
    archive(state.cloth, state.past, state.contact_energy, state.time, state.time_error);
    archive(state.control.length, state.control.left, state.control.error_ratio_before, state.control.just_rejected);
}

template <class Archive, OfType<KeyedForce> Value>
void exchange(Archive& archive, Value& row) {
    archive(row.key.vertex, row.key.obstacle, row.key.feature, row.force.normal, row.force.friction, row.force.stiffness,
            row.force.direction);
}

template <class Archive, OfType<ClothAnchor> Value>
void exchange(Archive& archive, Value& anchor) {
    archive(anchor.vertex, anchor.weight, anchor.normal, anchor.stretch);
}

template <class Archive, OfType<SavedContact> Value>
void exchange(Archive& archive, Value& contact) {
    archive(contact.last, contact.lasting, contact.cloth_anchors, contact.energy, contact.min_distance);
}

template <class Archive, OfType<StartMove> Value>
void exchange(Archive& archive, Value& move) {
    archive(move.cloth, move.obstacle, move.cloth_name, move.obstacle_name, move.vertices_moved, move.largest_move);
}

template <class Archive, OfType<SavedWorld> Value>
void exchange(Archive& archive, Value& saved) {
    archive(saved.changed, saved.plan_outdated, saved.waiting);
    archive(saved.settings.time_step, saved.settings.gravity, saved.settings.wind);
    archive(saved.state, saved.contact, saved.free, saved.pin_targets, saved.obstacles, saved.seams, saved.sewn_directions,
            saved.holds.welds, saved.holds.limits, saved.clamps);
    archive(saved.plan, saved.rest, saved.solver_is_set);
    archive.choice(saved.solver.first, 4);
    archive.choice(saved.solver.in_use, 4);
    archive(saved.start_moves, saved.loads, saved.detector);
}

}  // namespace percale
