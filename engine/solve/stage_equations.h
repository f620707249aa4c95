#pragma once

#include "implicit_stage.h"
#include "linear/block_matrix.h"
#include "percale/report.h"

namespace percale {

/// The equations of one stage: positions from velocities, the part of a move that is free of crossing, forces, residual and
/// objective. Points of the search are values that callers hold.
class StageEquations {
public:
    /// Begins the stage with springs, friction and contact. Views all; `matrix` has the pattern and the masses of the model.
    StageEquations(const ImplicitStage& stage, const ContactWarmStart& warm_start, StageSpace& space, const BlockMatrix& matrix,
                   StageTimes& times);

    /// The first point of the search: the start of the stage moves on along q* + h v_n (without gravity, which would press into
    /// contact, and friction would then freeze everything), prescribed vertices and obstacles to their ends, clamped where
    /// something would cross. The detector learns where this move leads. Evaluates nothing; `trial` and `direction`: work space.
    void begin(StagePoint& point, StagePoint& trial, Vec3Arrays& direction);

    /// to = from + factor * direction, m/s, with pins and obstacles at that fraction of what is left of their motion.
    void move(const StagePoint& from, const Vec3Arrays& direction, double factor, StagePoint& to) const;
    /// Shortens a move to what the detector proves free of crossing; returns the fraction of it that was kept.
    double clamp(const StagePoint& from, StagePoint& to);

    /// Whether a first point has more energy, contact's and of inertia, than the start of the stage, `start`; of scenes in which
    /// nothing moves by itself, as obstacles and pins do work.
    bool starts_too_high(const StagePoint& point, const StagePoint& start) const;
    /// Moves a point half of the way back to the start.
    void halve_prediction(const StagePoint& start, StagePoint& point) const;

    /// Computes all forces at a point, its residual and its objective. `accepted`: the last accepted point; null: this is the
    /// first evaluation of the stage, by which projection sets its stiffness.
    void evaluate(StagePoint& point, const StagePoint* accepted);

    /// The motion is solved at a point: contact updates what it holds fixed, and the forces there; false if nothing is left to
    /// be solved.
    bool correct_contact(StagePoint& point, double enough);

    /// The stage ends at a point.
    void end_contact(const StagePoint& point, ContactWarmStart& warm_start) const;

    /// Whether pins and obstacles are at the end of their motion there.
    bool arrived(const StagePoint& point) const { return point.fraction >= stage_.substep.to; }
    bool damps_velocity() const { return space_.springs.velocity_damping; }
    const ImplicitStage& stage() const { return stage_; }
    StageTimes& times() const { return times_; }
    double smallest_fraction() const { return smallest_fraction_; }
    double largest_stiffness() const { return largest_stiffness_; }

private:
    void set_start(StagePoint& point) const;
    void set_prediction(StagePoint& start, Vec3Arrays& direction) const;
    void place(StagePoint& point) const;
    double inertia(const StagePoint& point) const;
    void add_contact(StagePoint& point, const StagePoint* accepted);
    void freeze(const StagePoint& point);
    void set_residual(StagePoint& point) const;
    ContactPoint contact_point(const StagePoint& point, const StagePoint* accepted) const;
    static ContactForces contact_forces(StagePoint& point);

    const ImplicitStage& stage_;
    StageSpace& space_;
    const BlockMatrix& matrix_;
    StageTimes& times_;
    ContactLaw& law_;
    double contact_dt_ = 0.0;         // s, for which weighted contact has the form of a step's contact
    double start_energy_ = 0.0;       // J, of contact at the start of the stage
    double smallest_fraction_ = 1.0;  // of all moves
    double largest_stiffness_ = 0.0;  // N/m, of contact
};

}  // namespace percale
