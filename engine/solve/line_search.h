#pragma once

#include <limits>

#include "body_states.h"
#include "contact/trial_contacts.h"
#include "newton_stop.h"
#include "stage_equations.h"

namespace percale {

/// The state of a line search: objective and slope (residual . direction) at its start and at a trial.
struct LineTrial {
    double start_objective = 0.0;  // J
    double start_slope = 0.0;      // J, < 0 for a descent direction
    double objective = 0.0;
    double slope = 0.0;
    /// False with contact, as friction has no potential and constraints come and go, and with damping by velocity. Armijo's rule
    /// on the known part then still suffices to accept a trial, but a slope that is gentle does, too.
    bool objective_known = true;
    /// One-sided curvature condition: slope <= curvature_constant |start_slope|, whatever the objective is.
    double curvature_constant = std::numeric_limits<double>::infinity();
};

/// Whether a trial is good enough: Armijo's rule on the objective, or, where that is flat to rounding or not known, a slope
/// beyond the minimum of at most 0.9 of the first one's size; never one beyond curvature_constant.
bool accept_trial(double fraction, const LineTrial& trial);

/// The factor for the next trial: the zero of the slope by the secant, kept within 0.15 ... 0.6.
double shorten(const LineTrial& trial);

/// A search along a direction.
struct LineTask {
    const TimeError& error;
    const Vec3Arrays& direction;  // m/s
    BodyStates& bodies;           // marked: whether the direction changes them by little
    /// Not null: the search may make no move (LineResult::met_contacts), and then finds the trial contacts, so that another
    /// direction can be computed.
    TrialContacts* trial_contacts = nullptr;
};

struct LineResult {
    bool small = false;         // the whole direction changes each unsettled body by newton_error_ratio of its time error at most
    bool tiny = false;          // a tenth of that, with pins and obstacles already in place
    bool full_step = false;     // the whole direction was taken, with pins and obstacles already in place
    bool stuck = false;         // the decrease predicted along it, or the move, is at the level of rounding: counts as converged
    bool went_on = false;       // a step prolonged by the secant was evaluated, accepted or not
    int backtracks = 0;         // shortened trials
    bool met_contacts = false;  // no move: the whole of it ends in trial contacts that were in no matrix
};

/// Moves `current` along a direction: a full step, clamped where something would cross and shortened until accept_trial agrees;
/// prolonged by the secant where the slope has hardly fallen. After max_line_trials trials the last one is taken. `trial`: work
/// space.
LineResult search_line(StageEquations& equations, const LineTask& task, StagePoint& current, StagePoint& trial);

}  // namespace percale
