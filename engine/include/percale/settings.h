#pragma once

#include <optional>

#include "percale/mesh.h"

namespace percale {

/// `automatic` is the cheapest of symplectic_euler and backward_euler that is stable; the others are described by
/// `percale explain scheme`.
enum class Scheme {
    forward_euler,
    symplectic_euler,
    midpoint,
    rk4,
    backward_euler,
    implicit_midpoint,
    trapezoid,
    bdf2,
    tr_bdf2,
    automatic,
};
enum class LinearSolver { automatic, cg, multigrid, direct };
enum class ContactResponse { penalty, projection };
enum class DampingForm { length_rate, velocity };
enum class StepMeasures { automatic, all, none, ledger };
enum class StartRule { repair, refuse };

/// The settings of a simulation's steps. options.h has the range and a sentence for every field.
struct StepSettings {
    double time_step = 1.0 / 60.0;  // s, advance of one call of Simulation::step
    /// Divide each step into as many shorter ones as `tolerance` asks for.
    bool adaptive = false;
    double tolerance = 1e-3;  // m of position error for each second of simulation; used if adaptive
    Scheme scheme = Scheme::backward_euler;
    /// At which Newton's method ends: the residual relative to the first of the stage, or to the momentum that gravity gives in
    /// it where that is larger. Empty: by newton_error_ratio.
    std::optional<double> newton_tolerance = {};
    /// The largest last change, over the time error of the stage, at which Newton's method ends; 0.001 ... 100. In adaptive steps
    /// 0.25 at most. Smaller: steps are nearer to exact ones, and cost more.
    double newton_error_ratio = 1.0;
    int newton_iterations = 50;  // at most; 1 = linearly implicit
    /// Newton iterations of one step, over all its substeps, repeated ones included; 0: no limit. Beyond them the step fails
    /// (StepStatus::work_limit), within a few more iterations.
    int work_limit = 10000;
    LinearSolver linear_solver = LinearSolver::automatic;
    ContactResponse contact_response = ContactResponse::penalty;
    /// length_rate: kd (l - l_n)/dt along the current direction, backward Euler only; velocity: kd (v_ij . d), as in all other
    /// schemes.
    DampingForm damping_form = DampingForm::length_rate;
    int threads = 1;  // of one simulation, 1 ... 64; 0: as many as are useful. Same bits for any number
    /// The contents of a step report besides contacts. all: energy, strain and speed; ledger: the energy balance (StepEnergy),
    /// too. none, automatic: neither (NaN); Simulation::energy, largest_strain and largest_speed compute them on demand, and a
    /// scene file's run asks for what its outputs need.
    StepMeasures measure = StepMeasures::automatic;
    /// repair: resolves initial penetration: cloth that starts through, inside or touching an obstacle, or with self_contact
    /// through such cloth, is moved out before the first step (Simulation::start_repair reports it); refuse: such a start is an
    /// error.
    StartRule start = StartRule::repair;
    bool skip = true;  // leave out what the scene does not need (Simulation::plan); false runs everything
    /// Stops all cloth (velocities become 0) after each step in which its potential energy, elastic, of gravity and of contact,
    /// has risen: swinging cloth comes to rest sooner, creeping cloth is not affected; the path has no physical meaning. Not
    /// while pins or obstacles move, seams close or wind blows. This is kinetic damping of dynamic relaxation (Barnes 1999, Form
    /// finding and analysis of tension structures by dynamic relaxation), by the potential instead of the kinetic energy.
    bool kinetic_damping = false;
    /// m/s. Cloth is still if it stays within half a second times this of one place; empty: within 0.002 of its thickness.
    std::optional<double> rest_speed = {};
    bool check_derivatives = false;        // after each step, of every force at its end state; slow, for those who change forces
    Vec3 gravity = Vec3(0.0, -9.81, 0.0);  // m/s^2
    std::optional<Vec3> wind = {};         // m/s, velocity of the air; empty: no air at all, (0, 0, 0): it stands still
    double air_density = 1.2;              // kg/m^3
};

}  // namespace percale
