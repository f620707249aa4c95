#pragma once

#include <chrono>
#include <cstddef>

/// Every numerical constant of the layer that decides something. Numbers that are no choice stand where they are used: sizes of
/// arrays, numbers of a formula or of a scheme, limits of what a user may enter, measured costs of plans (plan/plan_costs.cpp),
/// and how the kernels lay out and divide their work (kernels/).
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

// ---- support/

/// How long a thread looks for more work before it goes to sleep: regions follow each other within microseconds, and waking a
/// thread takes tens of them. Longer: other programs get less of the cores. Shorter: every region waits for threads to wake. The
/// second number counts the looks between two readings of the clock. Cost alone.
constexpr std::chrono::microseconds longest_spin(20);
constexpr int spins_between_looks = 8;

/// s beyond the time limit of a step that a linear solve may take. 0: a solve that ends at its first iteration gives velocities
/// of 50 m/s. Minutes: a step whose solve does not end exceeds the limit.
constexpr double linear_grace_s = 0.5;

/// Threads of one pool, and the work that a thread should have before `threads = auto` uses another one (cost alone).
constexpr int max_threads = 64, min_vertices_a_thread = 1000;

// ---- mesh/

/// Twice the area over the square of the longest edge. Triangles with less are refused: their height is rounding. Smaller: a
/// triangle without a direction gets into the model. Larger: real needles are refused.
constexpr double min_triangle_area = 1e-12;

/// Volume over area^1.5 of a closed mesh (0.094 for a ball). A mesh with less is flat: its volume is rounding.
constexpr double min_enclosed_ratio = 1e-9;

/// Areas of the triangles around a vertex, summed with their directions, over the products of their edges. A vertex with less
/// has no normal. Smaller: rounding counts as a normal. Larger: needles have no normal.
constexpr double min_normal_ratio = 1e-12;

/// Bits of each axis along the curve that orders the vertices; three axes fit into 63. Fewer: vertices of a fine mesh share a
/// cell and keep their order. Cost alone.
constexpr int curve_key_bits = 20;

/// Vertices along the curve that are sorted by their springs: 16 slices, 8 KB of positions. More: neighbours lie farther apart
/// in memory. Fewer: more padding. Cost alone.
constexpr std::size_t vertex_sorting_window = 256;

/// Radians. Below it the chord between two turns differs from the arc by less than rounding, and sines would divide 0 by 0.
constexpr double min_arc = 1e-5;

// ---- model/

/// Radians. Smaller rest angles count as 0, those between triangles that curve with a radius of a thousand edges or more.
/// Smaller: the rounding of a file makes hinges of flat panels curved (8 digits: by 4e-5), which costs more and takes long to
/// solve where cloth folds together.
constexpr double min_rest_angle = 1e-3;

/// Radians up to which a triangle of a rest shape lies on its neighbour and both count as unfolded. 0: rounding decides.
constexpr double rest_fold = 1e-6;

/// Fraction of a given warp that must lie in the plane of each triangle. Smaller: warp is rounding there. Larger: bodies of
/// cloth that curve away from it are refused.
constexpr double min_warp_ratio = 1e-3;

/// Fraction of a cell's size (of its square, for its corner's cosine). A grid whose cells differ by less is regular and gets
/// hinges along its lines. Smaller: grids given in single precision get hinges of triangles. Larger: bending has an error of
/// that size.
constexpr double grid_cell_error = 1e-6;

/// Fraction of the shear modulus by which a fabric may differ from an isotropic one and count as isotropic.
constexpr double isotropic_shear_error = 1e-3;

/// Fraction of the places of all bands that springs must fill. Springs that fill fewer are kept in slices. Cost alone.
constexpr double min_band_filling = 0.7;

/// Vertices. Wider grids leave the caches: the many arrays that bands read side by side are then slower than slices, which read
/// one (percale_force_cost at N = 257: a product took 1.5 times as long). Cost alone.
constexpr std::size_t longest_band_guard = 512;

/// Longest edge of a triangle over its height at rest. Cloth of moduli with more is factorised, or a warning names it. Larger:
/// iterative solvers stop too early, with more error than the time step's.
constexpr double sliver_aspect = 100.0;

/// s. Damping time of the shipped fabrics, which was not measured. Larger: cloth moves as in oil. 0: oscillations do not decay.
constexpr double preset_damping_time = 2e-3;

// ---- forces/

/// Slices. Springs in bands are summed in chunks of this length: each begins with the springs of the guard before it once more.
/// Cost alone; the order of sums depends on it.
constexpr int band_chunk_slices = 128;

/// Square of the sine between an edge and its neighbour at one vertex. A narrower triangle has no direction any more, and its
/// hinge no angle. 0: a division by 0.
constexpr double min_hinge_sine_square = 1e-28;

/// m. Shorter springs have no direction and no force; the kernels hold the square (kernels/spring_kernel.inl). If the two
/// differ, the ledger counts forces that did not act.
constexpr double min_spring_length = 1e-18;

/// Pa, of the air around the cloth (the standard atmosphere at sea level), which compresses an amount of gas. Larger: cloth that
/// encloses gas is stiffer against a change of its volume.
constexpr double air_pressure = 101325.0;

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

/// Smallest mollifier of a constraint that receives forces of others. Smaller: forces go to constraints that hardly act.
constexpr double min_transfer_ratio = 0.5;

/// Cosine between the directions of constraints that pass forces on to each other. Less: they may lie on two sides of a gap. 1:
/// forces stay behind where facets turn.
constexpr double min_transfer_cosine = 0.9;

/// Fraction of the step matrix that the stiffness of a projected constraint has. Smaller: more rounds of multipliers. Larger:
/// each takes Newton longer.
constexpr double projection_stiffness_ratio = 1.0;

/// s, time constant with which cloth that is too near comes back to h. Shorter: it is thrown off. Longer: it stays too near.
constexpr double thickness_recovery_time = 0.05;

/// Fraction of the activation distance beyond its target within which a constraint's force ends. 1: constraints that leave the
/// activation distance still push.
constexpr double multiplier_activation_ratio = 0.9;

/// Fraction of the step matrix that the contact stiffness takes. Smaller: cloth sinks in. Larger: Newton takes longer.
constexpr double penalty_stiffness_ratio = 0.5;

/// Factor of the load on a constraint over h, which is its minimum stiffness. At 4 cloth rests at 3/4 h or more.
constexpr double static_load_factor = 4.0;

/// Fraction of h that an obstacle moves along the normal in a step; beyond it contact stiffness follows from this step's length
/// alone. Smaller: obstacles that hardly move throw up what lies on them. Larger: fast ones meet cloth whose contact is too
/// soft.
constexpr double moving_obstacle_ratio = 0.2;
/// Fraction of h within which contact in a substep shorter than its step stops cloth at the speed of a moving obstacle. Stages
/// of TR-BDF2 are as stiff as their length makes them where the obstacle moves by moving_obstacle_ratio. Smaller: adaptive steps
/// throw cloth.
constexpr double stopping_ratio = 1.0 / 12.0;

/// Fraction of h. A constraint's distance at the start of a move counts as at least this: the ledger's potential has no bound at
/// 0.
constexpr double min_start_ratio = 1e-3;

// ---- schemes/: the longest stable step of a Runge-Kutta scheme is searched along a ray, in units of 1/|lambda|

/// Shorter stable steps count as none. The second number is the factor from one trial to the next. Larger: a gap of the stable
/// region may be stepped over. Cost.
constexpr double min_stable_step = 1e-6, stable_step_march = 1.02;

/// Fraction of |R| that rounding adds to 1. 0: stable steps are found unstable.
constexpr double growth_rounding = 1e-12;

/// Where the search ends: no Taylor polynomial of degree 4 or less is stable there. The second number counts the halvings of the
/// interval in which stability is lost; 53 exhaust a double.
constexpr double beyond_stable_step = 4.0;
constexpr int stable_step_halvings = 60;

// ---- linear/

/// Iterations of block Jacobi from which multigrid is cheaper, and after which a solve goes on with multigrid. Coarser levels
/// are made anew when iterations exceed those of their first solve by a factor and by a number. Cost alone.
constexpr int dear_jacobi_iterations = 25, max_jacobi_iterations = 40;
constexpr int stale_level_factor = 2, stale_level_excess = 2;

/// Vertices up to which `automatic` factorises where iterative solvers are not exact enough. More: steps take seconds. Fewer:
/// small cloth with slivers is not solved exactly.
constexpr int max_factorised_vertices = 2000;

/// Vertices of the largest bottom level of multigrid, which is inverted densely. Cost alone.
constexpr int dense_vertices = 30;

/// Damping of the block Jacobi smoother. It leaves eigenvalues up to 2 for springs and up to about 2.8 on coarser levels: with
/// more than 2/2.8 it would amplify them. (Chebyshev polynomials of degree two need fewer cycles, but each reads the matrix
/// twice as often.)
constexpr float jacobi_damping = 0.7f;

/// Factor of the damping at vertices sewn to points, whose eigenvalues go up to 3. 1: conjugate gradient takes hundreds of
/// iterations where sewn points are stiffer than the cloth.
constexpr float sewn_point_easing = 2.0f / 3.0f;

/// Sweeps over contact constraints that filter what multigrid transfers to coarser levels and back, where constraints between
/// cloths are stiffer than this many times their vertex along all axes together. Cost alone: softer constraints gain less than
/// the sweeps take.
constexpr int constraint_sweeps = 3;
constexpr double stiff_constraint_factor = 1.0;

/// Pairs in a thread's part, and from which number on the work is divided. Cost alone.
constexpr int pair_grain = 512, min_shared_pairs = 2048;
constexpr int constraint_grain = 256, min_shared_constraints = 512;  // of contact constraints

/// Coefficient of a finer pair's block in a coarser one. Smaller ones are left out. Larger: coarser levels miss stiffness.
constexpr double min_galerkin_coefficient = 1e-4;

/// Fraction of vertices that a coarser level may keep; with more it gains nothing and the hierarchy ends.
constexpr double max_coarse_ratio = 0.8;

/// Levels of multigrid. Fewer: the bottom may be too large to be inverted. The second number counts the vertices of a level that
/// are sorted by degree together: cost alone.
constexpr int max_multigrid_levels = 12, level_sorting_window = 128;

/// Fraction of the strongest pair at one end from which a pair is strong; the second value serves where the first keeps too many
/// vertices. Larger: coarser levels stay large. Smaller: they are poor where springs differ in stiffness.
constexpr double strong_pair_ratio = 0.25, lower_pair_ratio = 0.03;

/// Fraction of vertices kept, above which weaker pairs count too.
constexpr double max_kept_ratio = 0.4;

/// Fraction of the largest interpolation weight below which a weight is dropped. Smaller: denser levels.
constexpr double min_weight_ratio = 0.03;

/// Regularisation of the second moment for each candidate: all may lie in a plane, or on a line. 0: a singular matrix.
constexpr double moment_regularisation = 1e-3;

/// m^2. Squares of distances between candidates are at least this, so that none divides by 0.
constexpr double min_candidate_square = 1e-24;

/// Fraction of the residual down to which floats are trusted. Smaller: iterations that gain nothing. Larger: more refinements.
constexpr double float_residual = 1e-4;

/// Refinements of a solve in floats by residuals in doubles; the fraction of the wanted residual that one aims at; and the
/// fraction of the previous residual that it may leave: with more, floats have broken down.
constexpr int max_refinements = 12;
constexpr double float_aim_ratio = 0.5, max_refined_ratio = 0.5;

/// Ratio of energy gains from one window to the next. Below it they fall fast, and the last window alone gives the estimate of
/// future gains. Larger: badly conditioned systems count as solved too early. (Inline, as a header reads it.)
inline constexpr double slow_gain_ratio = 0.8;

/// The largest ratio in the sum of the future gains. 1: no bound.
inline constexpr double max_gain_ratio = 0.99;

// ---- plan/

/// Power iterations for the highest frequency. Fewer: the frequency is too low, and the stable step too long.
constexpr int power_iterations = 40;

/// Fraction of the estimated stable step that `automatic` takes. 1: the estimate is an upper bound, and cloth may diverge.
constexpr double stable_step_ratio = 0.8;

/// s. The step that `automatic` assumes for adaptive TR-BDF2 where it compares costs.
constexpr double usual_implicit_step = 1.0 / 240;

/// w dt of trapezoid and implicit midpoint from which a plan warns that they ring.
constexpr double max_ringing_phase = 3.0;

/// Vertices above which a plan warns of one Newton iteration a step.
constexpr int fine_sheet_vertices = 4000;

/// Largest number of parts of a step, far more than are cheaper than an implicit one.
constexpr int max_explicit_parts = 1000;

/// Fraction of a spring's length in the differences of the forces of triangles and hinges. Smaller: rounding. Larger: curvature.
constexpr double shape_difference_ratio = 1e-5;

// ---- solve/

/// Largest number of trials in one line search. Fewer: steps are accepted that lower nothing.
constexpr int max_line_trials = 10;

/// Strong Wolfe constant: the slope beyond the minimum, over the first slope's size, up to which a step is accepted whatever the
/// objective is: friction is not in it, and steps that overshoot by more oscillate for ever. It is smaller where contact is
/// projected, unless the step changes little: constraints that were in no matrix stop the cloth half-way, and the next step
/// would lead back as far.
constexpr double strong_wolfe_constant = 0.9, max_projected_slope = 0.3;

/// The same where the objective is flat to rounding or not known, and the slope decides.
constexpr double gentle_slope = 0.9;

/// Armijo constant: the fraction of the first slope by which the objective has to fall. Towards 1: good steps are shortened.
constexpr double armijo_constant = 1e-4;

/// Fraction of the objective by which it may rise and count as flat. 0: rounding refuses the last steps of a solve.
constexpr double flat_objective = 1e-9;

/// Slope over the objective below which slopes are rounding. 0: a search at the solution never ends.
constexpr double flat_slope = 1e-12;

/// The smallest and the largest factor of the next trial, and the one where the secant gives none.
constexpr double min_shortening = 0.15, max_shortening = 0.6, blind_shortening = 0.5;

/// Fraction of the first slope that is left after a full step, from which on a longer step pays for its evaluation.
constexpr double slope_left_ratio = 0.6;

/// The longest step by the secant, and the smallest relative fall of the slope by which the secant divides.
constexpr double longest_secant_step = 3.0, min_secant_fall = 0.1;

/// Fraction of a slope that has turned which trial contacts, out of range until then, must cause: then a new direction is found
/// with them in the matrix. Larger: the step is shortened instead, again and again while sheets land. Smaller: directions are
/// found in vain.
constexpr double trial_slope_ratio = 0.5;

/// Fraction of the allowed change (StepSettings::newton_error_ratio) where the change is only estimated. Larger: changes that
/// are not small count as small. Smaller: more iterations.
constexpr double estimate_safety = 0.4;

/// Largest StepSettings::newton_error_ratio in adaptive steps. Larger: the solver's error exceeds the tolerance.
constexpr double max_adaptive_ratio = 0.25;

/// Newton iterations of a solve after which the nonlinear elimination of local subsets begins. Fewer: solves that soon end pay
/// for it. More: layers that slide on each other take two to three times as many.
constexpr int iterations_before_subsets = 8;

/// Largest number of vertices that subsets begin with: a fraction of all, but not less than a number. More: subsets cost what
/// all cloth does.
constexpr double max_subset_vertices = 0.02;
constexpr int few_subset_vertices = 20;

/// Fractions of the residual's square: what these vertices are chosen to hold, and what they must hold for subsets to pay.
constexpr double subset_square = 0.95, min_subset_square = 0.8;

/// When the solve of a subset ends: at this fraction of its residual, or after so many iterations.
constexpr double subset_residual_ratio = 0.1;
constexpr int max_subset_iterations = 8;

/// The same for the linear systems of subsets. Smaller, more: accuracy that the next state of contact makes useless.
constexpr double subset_linear_ratio = 0.1;
constexpr int max_subset_linear_iterations = 200;

/// Rounds of contact multipliers in one stage. Fewer: projected contact is left inexact.
constexpr int max_contact_rounds = 6;

/// Largest error of contact, fraction of h: contact less exact takes another round, however large the time error is.
constexpr double contact_round_ratio = 0.01;

/// h over the smallest change that means something without contact (2e-5 h). Smaller: cloth near rest is left unsolved.
constexpr double thickness_over_smallest_change = 5e4;

/// Fraction of an adaptive stage's allowance below which a change means nothing.
constexpr double negligible_allowance_ratio = 0.1;

/// Relative. Smaller moves are rounding of positions (a few units in the last place of a double).
constexpr double position_rounding = 1e-15;

/// Squares of lengths that are smaller by this factor are smaller by more than rounding. Cost alone.
constexpr double strain_rounding = 1.0 - 1e-12;

/// How much more a cloth's worst vertex may change than its mean: a factor of its allowed ratio to the time error, and one of
/// the smallest meaningful change.
constexpr double worst_vertex_factor = 2.0, worst_vertex_floor_factor = 10.0;

/// Accuracy of the linear solve, relative in the energy norm. Larger: more Newton iterations. Smaller: each is more expensive.
constexpr double linear_energy_accuracy = 0.2;

/// Fraction of its momentum that a linear solve with contact may leave in a body that nothing holds. Larger: sheets that slide
/// tremble, and friction between cloths is too large. Smaller: more linear iterations.
constexpr double net_momentum_ratio = 0.05;

/// Relative residual at which a linear solve ends, whatever its energy.
constexpr double min_linear_residual = 1e-10;

/// With a residual to reach, the linear residual follows Newton's: factor of the squared ratio, its minimum and its maximum
/// (Eisenstat and Walker 1996, choice 2, gamma = 0.9).
constexpr double forcing_factor = 0.9, min_forcing = 1e-6, max_forcing = 0.1;

/// Fraction of the residual to reach that the last linear solve aims at, and the largest linear residual at all.
constexpr double last_forcing_ratio = 0.3, loosest_forcing = 0.3;

// ---- substep/: impacts

/// h per second, besides what gravity causes in a stage: what comes more slowly is in no impact. Larger: bounces end early. 0:
/// they never do, and persistent contacts count as impacts.
constexpr double min_impact_rate = 2.0;

/// Fraction of an impact's speed that each step leaves after the point was stopped; until it is slow, contact cannot make the
/// point leave. Larger: persistent contacts count as impacts. Smaller: contact that is still compressed throws it off.
constexpr double impact_fading = 0.9;

// ---- substep/: lengths of adaptive steps

/// s. The first step is short, as a start may release something stiff.
constexpr double first_adaptive_step = 5e-5;

/// s. Shorter steps are accepted whatever their error is. Longer: errors go unnoticed. Shorter: impacts take for ever.
constexpr double shortest_step = 1e-7;

/// Fraction of the allowance that the next step aims at. Towards 1: more rejected steps. Smaller: more steps.
constexpr double wanted_error_ratio = 0.5;

/// The smallest ratio of error to allowance that counts, so that the length stays bounded after a step without error.
constexpr double min_error_ratio = 1e-6;

/// s of allowance: the maximum that can be left over, and the minimum of a step in contact. Larger: errors exceed the tolerance
/// for as long. 0 in contact: impacts, whose error goes with dt, force the shortest step.
constexpr double max_left_allowance = 0.02, min_contact_allowance = 0.005;

/// Exponents of the PI controller (Soderlind 2002), over the order. Larger: lengths swing to and fro.
constexpr double control_proportional = 0.4, control_integral = 0.7;

/// Factors from one length to the next: the minimum and the maximum; the maximum after a rejected step, and a factor of safety.
constexpr double min_length_factor = 0.2, max_length_factor = 2.0, max_rejected_factor = 0.5, rejected_safety = 0.9;

/// Fraction of a count of steps. The remaining time is divided into one step less if the steps are longer by only this. 0:
/// rounding adds a step of no length.
constexpr double step_count_rounding = 1e-9;

// ---- step/

/// s per second: how fast the time step that sets the contact stiffness may become shorter. Stiffness goes as 1/dt^2, and a
/// stiffer contact stores energy that no work has supplied; slowly against its own period, 2 pi sqrt(2) dt, it stores none.
constexpr double fastest_contact_shortening = 0.05;

/// s for which cloth has to be still to sleep, and fraction of h that it may move meanwhile. Shorter, larger: slow cloth
/// freezes. Longer, smaller: cloth at rest is solved for ever.
constexpr double rest_time = 0.5, rest_displacement_ratio = 0.002;

/// Fraction of a vertex's weight that forces on it may leave in cloth at rest. Larger: a swing sleeps where it turns.
constexpr double rest_force_ratio = 0.02;

/// RestState::unrest grows by the first number with each step in which the potential rises and falls by 1 in every other step,
/// so that it grows where every third step rises. From the second number on each step stops cloth for so many s. Smaller: a
/// swing creeps to rest.
constexpr int unrest_of_rise = 3, max_unrest = 12;
constexpr double stopping_time = 2.0 * rest_time;

/// Largest motion in one part of a step: rotation of an obstacle in radians, and translations of an obstacle and of a pin in
/// thicknesses. Larger: parts that vertices on straight lines do not follow, and lists of contacts that grow. Smaller: more
/// parts.
constexpr double largest_part_turn = 0.26179938779914943, largest_part_travel = 20.0, largest_pin_travel = 80.0;

/// m or m/s: largest positions and velocities that a program may give. Larger: squares lose all digits, or are infinite.
constexpr double largest_given_number = 1e9;

/// Newton iterations of a step whose time is up in which pins and obstacles have to arrive, or the step fails. Smaller: steps
/// fail that would have arrived. Larger: those that do not arrive delay their host for longer.
constexpr int max_late_iterations = 20;

/// Largest number of parts of a step. More: steps of many seconds that throw cloth. Rounding: the excess of a count of parts
/// over a whole number; m, by which a pin that goes with an obstacle may miss its place on it.
constexpr int max_step_parts = 64;
constexpr double part_rounding = 1e-9, carried_pin_error = 1e-8;

/// Parts of a step, asked for by the travel of one thing, from which the report states that it may have jumped.
constexpr int jump_parts = 8;

/// Strain of held cloth from which the report of a step that failed, or did not converge, names the cloth.
constexpr double reported_strain = 1.0;

/// Halvings of one substep, one inside the other: the shortest is 1/64 of it. Fewer: hard impacts end as steps that did not
/// converge. More: a step that cannot be solved costs twice as much with each before it ends.
constexpr int max_halvings = 6;

/// s, m. Time in which a weld takes up its gap, and the gap at which its spring's force is the largest that it holds with.
/// Shorter: stitches swing. Wider: a seam that something keeps open pulls harder and harder.
constexpr double weld_time = 0.05, widest_weld = 0.01;

/// N/m: limit of an edge without stiffness, whose ends are sewn together. 0: a division by 0.
constexpr double min_limited = 1e-12;

/// Strain limits: k and the largest hold over an edge's own stiffness; s, in which a hold takes up the excess. Larger k: more
/// iterations. Smaller: more steps until the limit is kept. Larger hold: a limit that cannot be kept pulls ever harder.
constexpr double limit_stiffness = 10.0, max_held_strain = 2.0, limit_time = 1.0 / 60.0;

// ---- step/: compliant obstacles

/// Surfaces give way from this fraction of the room that two activation distances have, at which the cloth between them begins
/// to be pressed. Larger: they give way before the contacts that show the pinch exist. Smaller: cloth is pressed hard.
constexpr double kept_room = 0.6;

/// h of room more than is kept that deflections leave unused, and h by which they return in a step. Slack 0: deflections go back
/// and forth for ever. Larger: they stay larger than necessary. Return larger: where cloth is just out of contact they come too
/// near, are pushed back, and tremble. Smaller: deflections last.
constexpr double deflection_slack = 0.2, deflection_return = 0.25;

/// h. A deflection that would change by less, and cloth that moves by less in a step, is at rest. 0: no deflection rests.
/// Larger: it stays where it should change.
constexpr double resting_deflection = 0.02;

/// h, and mean edges: how far around a pressing point the surface goes along. Smaller: spikes. Larger: deflections wider than
/// the cloth.
constexpr double deflection_thicknesses = 4.0, deflection_edges = 2.0;

/// Factor by which the corners around a pressing point retreat more than it has to, since a point inside a triangle moves less.
/// Smaller: more steps until there is room. Larger: more room than is kept.
constexpr double beyond_press = 1.2;

/// Weight in a contact from which it presses a vertex, and fraction of a retreat below which a vertex has not moved. Larger:
/// pairs that pinch are not seen. Smaller: places that hardly matter count.
constexpr double min_pressing_weight = 0.05, min_deflection_ratio = 0.1;

/// Cosines between the directions of two contacts: the maximum for contacts on opposite sides of cloth, the minimum for those on
/// one side. Nearer to 0: surfaces beside each other count as a pinch. Farther: slanted ones are not seen.
constexpr double opposite_sides = -0.5, same_side = 0.5;

/// Passes over contacts between cloths; each sees through at least one layer. Fewer: thick bundles are pinched unseen.
constexpr int compliant_passes = 3;

/// Numbers of equal parts into which a step is divided, in turn, where a surface came up too fast to give way in time. Cost
/// alone, but for the last: a surface too fast for it fails the step.
constexpr int compliant_parts[] = {4, 16, 64};

// ---- checks/: derivatives against differences, for settings.check_derivatives. Smaller: right forces are found wrong. Larger:
// wrong ones pass.

/// Fraction of the vertex's own value, and of the largest of all.
constexpr double derivative_accuracy = 1e-4, derivative_floor_accuracy = 1e-5;

/// Fraction that rounding leaves of sums of forces and of energies.
constexpr double derivative_rounding = 1e-12;

/// Chunks of vertices whose energy slope is compared by itself. Fewer: a wrong force hides among more right ones.
constexpr int derivative_chunks = 16;

/// Fraction of the shortest spring, the displacement of vertices. The others are multiples of that displacement: how near the
/// kinks of wind (as a distance in dt), of contact and of strain limits a vertex is left out.
constexpr double difference_step_ratio = 1e-5, wind_kink_reaches = 1e3, contact_kink_reaches = 10.0, limit_kink_reaches = 4.0;

// ---- start/

/// Strain that a start may have after initial penetration was resolved (where it had less before), and at which relaxing ends.
/// Larger: torn starts are accepted.
constexpr double max_start_strain = 0.5, good_start_strain = 0.1;

/// How often cloth leaves obstacles and cloth in turn. Fewer: cloth moved out of one is left in the other. Cost, of hopeless
/// starts.
constexpr int max_repair_turns = 8;

/// Steps of relaxing, and their length in s.
constexpr int max_relaxations = 60;
constexpr double relaxation_step = 1.0 / 60.0;

/// Fraction by which strain has to fall, and consecutive steps without such a fall after which relaxing ends. Fewer: starts are
/// refused that would have relaxed.
constexpr double relaxed_ratio = 0.01;
constexpr int max_idle_relaxations = 10;

/// Fraction of h. Vertices that resolving penetration moved by less are not reported.
constexpr double reported_move_ratio = 0.1;

}  // namespace percale
