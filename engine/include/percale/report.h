#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>

#include "percale/settings.h"

namespace percale {

enum class StepStatus {  // those up to tolerance_missed are accepted
    ok,
    halved,             // ok, but only after the step was redone as shorter ones
    not_converged,      // accepted at the limit of iterations or time; the residual is the measure of the error
    tolerance_missed,   // adaptive: accepted at the shortest possible length, smallest_dt, with an error above the tolerance
    pin_blocked,        // failed: a pin could not reach its target without crossing an obstacle, or is to jump too far
    obstacle_too_fast,  // failed: the cloth could not follow a moving obstacle
    wrong_derivative,   // failed: StepSettings::check_derivatives found forces that do not fit energy or matrix
    not_finite,         // failed: a state would have become infinite or NaN; the state is that of the step's start
    work_limit,         // failed: more Newton iterations than StepSettings::work_limit allows; or out_of_time
    cancelled,          // failed: Simulation::set_cancel
};

/// The outcome of a substep, a part of a step that one application of the time integrator advances. All but `solved` drop it, and
/// it is solved again in shorter ones. Where it cannot be shorter, or time is up, `not_converged` is kept as it is; where it
/// cannot be shorter, the others fail the step.
enum class SubstepOutcome {
    solved,
    not_converged,  // the solver used up its iterations
    blocked,        // pins, obstacles or cloth could not reach the end of their path without crossing
    not_finite,     // a state would have become infinite or NaN
    inexact,        // adaptive steps: the estimated error is above the tolerance
};

/// The number of substeps of a step that were dropped and solved again, by outcome. `inexact` counts rejected lengths of adaptive
/// steps, each of one or more substeps; the others add up to StepReport::halvings.
struct DroppedSubsteps {
    int not_converged = 0, blocked = 0, not_finite = 0, inexact = 0;

    void add(SubstepOutcome end);  // nothing for `solved`
    DroppedSubsteps& operator+=(const DroppedSubsteps& more);
    int total() const { return not_converged + blocked + not_finite + inexact; }
    /// "2 not converged, 1 blocked"; empty if none was dropped.
    std::string text() const;

    bool operator==(const DroppedSubsteps&) const = default;
};

/// CPU seconds of the calling thread, by stage.
struct StageTimes {
    double refresh = 0.0, evaluate = 0.0, force = 0.0, setup = 0.0, solve = 0.0, cut = 0.0, measure = 0.0;

    StageTimes& operator+=(const StageTimes& more) {
        refresh += more.refresh;
        evaluate += more.evaluate;
        force += more.force;
        setup += more.setup;
        solve += more.solve;
        cut += more.cut;
        measure += more.measure;
        return *this;
    }
};

/// Energies at the end of a step and their balance during it, J. In a step report all are NaN unless StepSettings::measure is
/// `all` or `ledger`, and all but the first five unless it is `ledger`.
struct StepEnergy {
    double kinetic = 0.0, gravity = 0.0;
    double elastic = 0.0;  // of springs, hinges, membranes and gas in closed cloth; under Fabric::pressure -pressure volume
    double contact = 0.0;  // of contact and of the springs by which friction sticks
    double work = 0.0;     // of pins and obstacles on the cloth

    double dissipated_material = 0.0;    // by the damping of springs
    double dissipated_friction = 0.0;    // friction force times slip
    double dissipated_contact = 0.0;     // contacts, or their stiffness, differ from those where the energy was stored
    double dissipated_integrator = 0.0;  // by the scheme; negative: gained
    double residual_work = 0.0;          // by the forces that the solver left unbalanced
    double imbalance = 0.0;              // change of total() + dissipated() - residual_work - work

    double total() const { return kinetic + gravity + elastic + contact; }
    double dissipated() const { return dissipated_material + dissipated_friction + dissipated_contact + dissipated_integrator; }
    /// |imbalance| relative to the largest of the other entries; 0 where all are 0.
    double closure() const;
};

/// The entries of the ledger: those that only StepMeasures::ledger fills.
inline constexpr std::array<double StepEnergy::*, 6> ledger_entries = {
    &StepEnergy::dissipated_material,   &StepEnergy::dissipated_friction, &StepEnergy::dissipated_contact,
    &StepEnergy::dissipated_integrator, &StepEnergy::residual_work,       &StepEnergy::imbalance};

/// Adds the transfers of another step (work and the ledger) to `sum`; its energies become those at the end of that step.
void add_step_energy(const StepEnergy& step, StepEnergy& sum);

/// Copies the stored energies, without work and ledger.
void set_stored_energy(const StepEnergy& stored, StepEnergy& energy);

/// The result of one step. A failed step leaves positions and velocities as they were. Energy, strain and speed are NaN where
/// StepSettings::measure leaves them out.
struct StepReport {
    StepStatus status = StepStatus::ok;
    double time = 0.0;         // s, at the end of the step
    double dt = 0.0;           // s
    double smallest_dt = 0.0;  // s, of the parts the step was solved in
    double largest_dt = 0.0;   // s, likewise
    int parts = 1;     // accepted lengths in an adaptive step, or equal parts of one in which an obstacle or a pin moves far
    int rejected = 0;  // lengths that it tried and found too inexact
    int newton_iterations = 0;
    int linear_iterations = 0;
    int line_search_cuts = 0;
    LinearSolver linear_solver = LinearSolver::automatic;  // in use at the end; automatic if nothing was solved
    int halvings = 0;                                      // number of substeps that were solved again as two halves
    DroppedSubsteps dropped;                               // the reasons for that, and for rejected adaptive lengths
    double residual = 0.0;    // relative to the first of the step, or to gravity's impulse where that is larger
    double time_error = 0.0;  // m, estimated error by the length of the step, mean of the worst cloth; the solver's own error is
                              // at most newton_error_ratio of it where no newton_tolerance is set, and where it converged. 0:
                              // explicit schemes, unless adaptive
    double smallest_fraction = 1.0;  // smallest collision-free step size of a move
    int sleeping_cloths = 0;         // at rest
    bool slept = false;              // all were: the step was not solved, the figures are those of the last one solved
    bool out_of_time = false;        // Simulation::set_time_limit ended it before it was solved
    bool stopped = false;            // kinetic damping set all velocities to 0 at its end
    int contacts = 0;                // contact constraints at the end
    double smallest_distance = 0.0;  // m; infinity if nothing was near
    double contact_stiffness = 0.0;  // N/m, largest of the step
    double largest_strain = 0.0;     // of structural springs, (l - l0)/l0; NaN unless it is measured
    double largest_speed = 0.0;      // m/s; likewise
    bool blocked_by_pin = false;     // pins stay, and the blocked vertex is one in an obstacle's way
    int blocked_cloth = -1;          // the cloth and vertex of a blocked pin, or of one in an obstacle's way
    int blocked_vertex = -1;
    int blocking_obstacle = -1;               // -1 where it is cloth, too; blocking_name then says so
    std::string blocked_name, blocking_name;  // of that cloth and obstacle
    double travel = 0.0;   // m, beside the cloth, of an obstacle or a pin that moves too far for a step, which is not tried
    double jump = 0.0;     // m, likewise, of one that moves so far that the step is made in 8 parts or more
    int pinched = 0;       // places where compliant obstacles give way to cloth, ObstacleSettings::yields
    double yielded = 0.0;  // m, largest deflection of a vertex of such an obstacle at the end
    bool yielded_in_vain = false;  // of a failed step: an obstacle that closed on the cloth gave way, but not enough in 64 parts
    std::array<int, 2> pinching{
        -1, -1};               // the obstacles between which the cloth has least room; both the same where one pinches it alone
    int second_obstacle = -1;  // pushes the cloth towards the blocking one
    std::string second_name;
    int stretched_cloth = -1;  // of a step that failed or did not converge: held by pins, stretched to more than twice its length
    int stretched_pins = 0;    // number of its pinned vertices
    double stretch = 0.0;      // its largest strain
    std::string stretched_name;
    std::string wrong_derivative;    // the first misfit: term, vertices, figures
    std::uint64_t contact_hash = 0;  // of the contact constraints at the end
    StepEnergy energy;
    StageTimes stages;
    double cpu_s = 0.0;  // s, of all threads

    bool ok() const { return status <= StepStatus::tolerance_missed; }
    /// Accepted with an incomplete solution.
    bool unsolved() const { return status == StepStatus::not_converged || status == StepStatus::tolerance_missed; }
    /// One sentence on the result, with figures.
    std::string explanation() const;
    void explain(std::FILE* out) const;
};

/// The move of a cloth that started through, inside or touching an obstacle, or through cloth.
struct StartMove {
    int cloth = -1;
    int obstacle = -1;  // -1: cloth
    std::string cloth_name = {}, obstacle_name = {};
    int vertices_moved = 0;     // by more than a tenth of the thickness
    double largest_move = 0.0;  // m
};

const char* status_word(StepStatus status);

/// The word of the option linear_solver for a solver in use; "none" for `automatic`, with which nothing was solved.
const char* solver_word(LinearSolver solver);

}  // namespace percale
