#pragma once

#include <limits>
#include <optional>

#include "stage_equations.h"

namespace percale {

/// What tells the error that the time step makes, against which the solver's own is held.
struct TimeError {
    const Compute* compute = nullptr;
    const ClothModel* model = nullptr;
    const AlignedVector<double>* free = nullptr;
    double dt = 0.0;                    // s, h of the stage
    const Vectors* start = nullptr;     // m/s, v_n
    const Vectors* foreseen = nullptr;  // StageBase::foreseen; null for backward Euler
    double foreseen_share = 1.0;
    double allowance = std::numeric_limits<double>::infinity();  // m, that adaptive steps give the stage
};

/// How large a change may be beside the time error: StepSettings::newton_share, in adaptive steps a quarter at most, as they are
/// as long as the time error alone allows.
double allowed_share(const StepSettings& settings);

/// Of a stage.
TimeError time_error_of(const ImplicitStage& stage);

/// |v - v_n|_M^2 over the free of some vertices, J: the time error of backward Euler is dt/2 times its root over the mass.
/// Another scheme's is as small as `foreseen_share` |v - foreseen|, where that is less.
double squared_error(const TimeError& error, int first, int count, const Vectors& velocities);

/// A Newton direction that leads to the velocities `ahead`.
struct NewtonChange {
    const Vectors& residual;   // kg m/s
    const Vectors& direction;  // m/s
    const Vectors& ahead;      // m/s
    bool in_contact = false;
};

/// The direction in the work space, which leads from space.current to the velocities `ahead`.
NewtonChange change_to(const StageEquations& equations, const Vectors& ahead);

/// Whether the direction changes every cloth of a body by less than a share of the time error, in the mean and at its worst
/// vertex by less than twice that; in metres, dt sqrt(-r . dv/m). What is below a share of the thickness (2e-5, in contact 2e-4)
/// or a tenth of the allowance, if that is less, means nothing.
bool change_is_small(const TimeError& error, const NewtonChange& change, double share, const Body& body);

/// The time error itself, m, in the mean of the worst cloth.
double time_error(const TimeError& error, const Vectors& velocities);

/// Where a Newton iteration stands.
struct NewtonProgress {
    int iteration = 0;
    double ratio = 1.0;     // of its residual to the one before
    double residual = 1.0;  // relative to the first
};

/// How exactly its linear system is solved. With a residual to reach, the linear residual follows the Newton residual (Eisenstat
/// and Walker 1996, choice 2); else the energy gained per iteration decides, which bounds the smooth error that a loose residual
/// leaves behind.
SolveTarget solve_target(const TimeError& error, const NewtonProgress& progress, const StepSettings& settings,
                         const Vectors& velocities);

}  // namespace percale
