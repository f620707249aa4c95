#pragma once

#include "implicit_stage.h"
#include "percale/report.h"

namespace percale {

/// The equations of one stage: positions from velocities, the part of a move that is free of crossing, forces, residual and
/// objective. Views the stage and its work space.
class StageEquations {
public:
    /// Begins the stage with springs, friction and contact. `space.current` is the start.
    StageEquations(const ImplicitStage& stage, const ContactWarmStart& warm_start, NewtonSpace& space, StageTimes& times);

    /// Moves `space.current` along q* + h v_n (without gravity, which would press into contact, and friction would then freeze
    /// everything), prescribed vertices and obstacles to their ends, clamped where something would cross. Evaluates nothing.
    void predict();

    /// space.trial = current + factor * direction, m/s, clamped to what the detector proves free of crossing. Returns the
    /// fraction of the move that was kept.
    void aim(double factor);
    double cut();

    /// Computes all forces at a point, its residual and its objective.
    void evaluate(StagePoint& point);

    /// The motion is solved: contact updates what it holds fixed; false if nothing is left to be solved.
    bool correct_contact(double enough);

    /// The substep ends at `space.current`.
    void end_contact(ContactWarmStart& warm_start) const;

    bool arrived() const { return space_.current.fraction >= stage_.substep.to; }
    const ImplicitStage& stage() const { return stage_; }
    NewtonSpace& space() const { return space_; }
    StageTimes& times() const { return times_; }
    double smallest_fraction() const { return smallest_fraction_; }
    double largest_stiffness() const { return largest_stiffness_; }

private:
    void place(StagePoint& point) const;
    void add_contact(StagePoint& point);
    void set_residual(StagePoint& point) const;
    ContactPoint contact_point(const StagePoint& point, bool first) const;
    static ContactForces contact_forces(StagePoint& point);

    const ImplicitStage& stage_;
    NewtonSpace& space_;
    StageTimes& times_;
    ContactLaw& law_;
    double contact_dt_ = 0.0;         // s, for which weighted contact has the form of a step's contact
    double smallest_fraction_ = 1.0;  // of all moves
    double largest_stiffness_ = 0.0;  // N/m, of contact
};

}  // namespace percale
