#pragma once

#include <chrono>
#include <cstddef>

/// The numerical constants of the layer that decide something and that several files use; one with a single user stands there.
///
/// After "Larger:" and "Smaller:" a comment states the effect of such a value. A constant of "cost alone" changes how long a
/// step takes and how exactly it is solved, within what is asked for; it may still change the bits of a run. Lengths of contact
/// are fractions of the thickness h, the distance below which cloth is in contact, usually 1 mm to 10 mm. (w: an angular
/// frequency; dt: the time step.)
namespace percale {

// ---- Shared

/// m/s^2, of the earth: of bending lengths in fabric presets, and of the weights that contact carries in a scene without gravity.
constexpr double standard_gravity = 9.80665;

// ---- support/

/// Threads of one pool, and the work that a thread should have before `threads = auto` uses another one (cost alone).
constexpr int max_threads = 64, min_vertices_a_thread = 1000;

// ---- model/

/// Longest edge of a triangle over its height at rest. Cloth of moduli with more is factorised, or a warning names it. Larger:
/// iterative solvers stop too early, with more error than the time step's.
constexpr double sliver_aspect = 100.0;

/// Strain limits: k and the largest hold over an edge's own stiffness. Larger k: more iterations. Smaller: more steps until the
/// limit is kept. Larger hold: a limit that cannot be kept pulls ever harder.
constexpr double limit_stiffness = 10.0, max_held_strain = 2.0;

// ---- contact/

/// Fraction of h. A smaller change means nothing in contact. Larger: stages end before contact is solved. Smaller: iterations
/// that change nothing visible.
constexpr double contact_accuracy = 2e-4;

/// Stick threshold, fraction of h: the slip up to which a contact sticks. Larger: cloth creeps visibly before it holds. Smaller:
/// the springs of friction get so stiff that Newton takes longer.
constexpr double stick_threshold_ratio = 0.01;

/// Activation ratio that a detector is asked for when contact is projected: constraints must be known before they are active,
/// and cloth at rest lies at h itself. 1: constraints come and go there. Larger: more constraints that never act.
constexpr double projection_activation_ratio = 1.2;

// ---- linear/

/// Vertices of the largest bottom level of multigrid, which is inverted densely. Cost alone.
constexpr int dense_vertices = 30;

/// Contact constraints in a thread's part, and from which number on the work is divided. Cost alone.
constexpr int constraint_grain = 256, min_shared_constraints = 512;

// ---- solve/

/// Largest number of trials in one line search. Fewer: steps are accepted that lower nothing.
constexpr int max_line_trials = 10;

// ---- substep/: lengths of adaptive steps

/// s. Shorter steps are accepted whatever their error is. Longer: errors go unnoticed. Shorter: impacts take for ever.
constexpr double shortest_step = 1e-7;

// ---- step/

/// Largest number of parts of a step. More: steps of many seconds that throw cloth.
constexpr int max_step_parts = 64;

// ---- compliant/, step/: pinches

/// Maximum of the cosine between the directions of two contacts on opposite sides of cloth. Nearer to 0: surfaces beside each
/// other count as a pinch. Farther: slanted ones are not seen.
constexpr double opposite_sides = -0.5;

}  // namespace percale
