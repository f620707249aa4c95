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

/// |q| - 1 of a rotation that a user gives, and |q|^2 - 1 of one in a saved state. Smaller: rotations read from text with six
/// digits are refused. Larger: a quaternion that was never meant to be a rotation is accepted.
constexpr double unit_length_error = 1e-6, unit_square_error = 1e-6;

/// m/s^2, of the earth: of bending lengths in fabric presets, and of the weights that contact carries in a scene without gravity.
constexpr double standard_gravity = 9.80665;

// ---- support/

/// Threads of one pool, and the work that a thread should have before `threads = auto` uses another one (cost alone).
constexpr int max_threads = 64, min_vertices_a_thread = 1000;

// ---- model/

/// Longest edge of a triangle over its height at rest. Cloth of moduli with more is factorised, or a warning names it. Larger:
/// iterative solvers stop too early, with more error than the time step's.
constexpr double sliver_aspect = 100.0;

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

/// Sweeps over contact constraints that filter what multigrid transfers to coarser levels and back, where constraints between
/// cloths are stiffer than this many times their vertex along all axes together. Cost alone: softer constraints gain less than
/// the sweeps take.
constexpr int constraint_sweeps = 3;
constexpr double stiff_constraint_factor = 1.0;

/// Pairs in a thread's part, and from which number on the work is divided. Cost alone.
constexpr int pair_grain = 512, min_shared_pairs = 2048;
constexpr int constraint_grain = 256, min_shared_constraints = 512;  // of contact constraints

// ---- solve/

/// Largest number of trials in one line search. Fewer: steps are accepted that lower nothing.
constexpr int max_line_trials = 10;

/// Residual ratio and iterations that end a subset's linear solve. Smaller, more: accuracy that the next state makes useless.
constexpr double subset_linear_ratio = 0.1;
constexpr int max_subset_linear_iterations = 200;

// ---- substep/: lengths of adaptive steps

/// s. Shorter steps are accepted whatever their error is. Longer: errors go unnoticed. Shorter: impacts take for ever.
constexpr double shortest_step = 1e-7;

// ---- step/

/// Largest motion in one part of a step: rotation of an obstacle in radians, and translations of an obstacle and of a pin in
/// thicknesses. Larger: parts that vertices on straight lines do not follow, and lists of contacts that grow. Smaller: more
/// parts.
constexpr double largest_part_turn = 0.26179938779914943, largest_part_travel = 20.0, largest_pin_travel = 80.0;

/// Largest number of parts of a step. More: steps of many seconds that throw cloth. Rounding: the excess of a count of parts
/// over a whole number; m, by which a pin that goes with an obstacle may miss its place on it.
constexpr int max_step_parts = 64;
constexpr double part_rounding = 1e-9, carried_pin_error = 1e-8;

/// Strain limits: k and the largest hold over an edge's own stiffness; s, in which a hold takes up the excess. Larger k: more
/// iterations. Smaller: more steps until the limit is kept. Larger hold: a limit that cannot be kept pulls ever harder.
constexpr double limit_stiffness = 10.0, max_held_strain = 2.0, limit_time = 1.0 / 60.0;

// ---- compliant/, step/: pinches

/// Maximum of the cosine between the directions of two contacts on opposite sides of cloth. Nearer to 0: surfaces beside each
/// other count as a pinch. Farther: slanted ones are not seen.
constexpr double opposite_sides = -0.5;

// ---- checks/: derivatives against differences, for settings.check_derivatives. Smaller: right forces are found wrong. Larger:
// wrong ones pass.

/// Fraction of the shortest spring, the displacement of vertices. The others are multiples of that displacement: how near the
/// kinks of wind (as a distance in dt), of contact and of strain limits a vertex is left out.
constexpr double difference_step_ratio = 1e-5, wind_kink_reaches = 1e3, limit_kink_reaches = 4.0;

}  // namespace percale
