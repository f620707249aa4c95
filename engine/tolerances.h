#pragma once

#include <chrono>
#include <cstddef>

/// Every numerical constant of the layer that decides something. What is no choice stands where it is used: sizes of arrays,
/// numbers of a formula or of a scheme, limits of what a user may enter, what plans were measured to cost (plan/plan_costs.cpp),
/// and how the kernels lay out and share their work (kernels/).
///
/// A constant of "cost alone" changes how long a step takes and how exactly it is solved, within what is asked for; it may still
/// change the bits of a run. Lengths of contact are given as shares of the thickness, h: the distance below which cloth is in
/// contact, usually 1 mm to 10 mm. (w: an angular frequency; dt: the time step.)
namespace percale {

// ---- Shared

/// |q| - 1 of a rotation that a user gives, and |q|^2 - 1 of one in a saved state. Smaller: rotations read from text with six
/// digits are refused. Larger: a quaternion that was never meant to be one is taken.
constexpr double unit_length_error = 1e-6, unit_square_error = 1e-6;

// ---- support/

/// How long a thread looks for more work before it goes to sleep: regions follow each other within microseconds, and waking a
/// thread takes tens of them. Longer: cores are kept from others. Shorter: every region waits for threads to wake. And looks
/// between two looks at the clock. Cost alone.
constexpr std::chrono::microseconds longest_spin(20);
constexpr int spins_between_looks = 8;

/// s beyond the time limit of a step that a linear solve may take. 0: one that is cut off at its first iteration gives velocities
/// of 50 m/s. Minutes: a step whose solve does not end does not heed the limit.
constexpr double linear_grace_s = 0.5;

/// Of one pool. And what a thread should have to do before `threads = auto` uses another one (cost alone).
constexpr int most_threads = 64, least_vertices_a_thread = 1000;

// ---- mesh/

/// Twice the area over the square of the longest edge. Triangles with less are refused: their height is rounding. Smaller: a
/// triangle without a direction gets into the model. Larger: real needles are refused.
constexpr double least_triangle_area = 1e-12;

/// Volume over area^1.5 of a closed mesh (0.094 of a ball). With less it is flat: what its volume is, is rounding.
constexpr double least_enclosed_share = 1e-9;

/// Areas of the triangles around a vertex, summed with their directions, over the products of their edges. With less the vertex
/// has no normal. Smaller: rounding is taken for one. Larger: needles have none.
constexpr double least_normal_share = 1e-12;

/// Bits of each axis along the curve that vertices are ordered by; three axes fit into 63. Fewer: vertices of a fine mesh share a
/// cell and keep their order. Cost alone.
constexpr int curve_key_bits = 20;

/// Vertices along the curve that are sorted by their springs: 16 slices, 8 KB of positions. More: neighbours lie farther apart
/// in memory. Fewer: more padding. Cost alone.
constexpr std::size_t vertex_sorting_window = 256;

/// Radians. Below it the chord between two turns differs from the arc by less than rounding, and sines would divide 0 by 0.
constexpr double least_arc = 1e-5;

// ---- model/

/// Radians. Smaller rest angles are none: over triangles that curve with a radius of a thousand edges or more. Smaller: what a
/// file rounds off makes hinges of flat panels curved (8 digits: by 4e-5), which costs more, and solves long where cloth folds
/// together.
constexpr double least_rest_angle = 1e-3;

/// Radians by which a triangle of a rest shape lies on its neighbour when they are taken as unfolded. 0: rounding decides.
constexpr double rest_fold = 1e-6;

/// Share of a given warp that must lie in the plane of each triangle. Smaller: warp is rounding there. Larger: bodies of cloth
/// that curve away from it are refused.
constexpr double least_warp_share = 1e-3;

/// Share of a cell's size (of its square, for its corner's cosine). A grid whose cells differ by less is regular and gets hinges
/// along its lines. Smaller: grids given in single precision get those of triangles. Larger: bending that is off by as much.
constexpr double grid_cell_error = 1e-6;

/// Share of the shear modulus that a fabric may differ from an isotropic one and count as isotropic.
constexpr double isotropic_shear_error = 1e-3;

/// Share of the places of all bands. Springs that fill fewer are kept in slices. Cost alone.
constexpr double least_band_filling = 0.7;

/// Vertices. Wider grids leave the caches: the many arrays that bands read side by side then are slower than slices, which read
/// one (percale_force_cost at N = 257: a product took 1.5 times as long). Cost alone.
constexpr std::size_t longest_band_guard = 512;

/// Longest edge of a triangle over its height at rest. Cloth of moduli with more is factorised, or warned of. Larger: iterative
/// solvers stop too early, with more error than the time step's.
constexpr double sliver_aspect = 100.0;

/// s. Damping time of the shipped fabrics, which was not measured. Larger: cloth moves as in oil. 0: it rings on.
constexpr double preset_damping_time = 2e-3;

// ---- forces/

/// Slices. Springs in bands are summed in longer chunks: each begins with the springs of the guard before it once more. Cost
/// alone; the order of sums depends on it.
constexpr int band_chunk_slices = 128;

/// Square of the sine between an edge and its neighbour at one vertex. A triangle as narrow as that has no direction any more,
/// and its hinge no angle. 0: a division by 0.
constexpr double least_hinge_sine_square = 1e-28;

/// m. Shorter springs have no direction and no force; the kernels hold the square (kernels/spring_kernel.inl). If the two
/// differ, the ledger counts forces that were none.
constexpr double least_spring_length = 1e-18;

/// Pa, of the air around the cloth (the standard atmosphere at sea level): what an amount of gas is squeezed by. Larger: filled
/// cloth is stiffer against a change of its volume.
constexpr double air_pressure = 101325.0;

// ---- contact/

/// Share of h. A smaller change means nothing in contact. Larger: stages end before contact is solved. Smaller: iterations that
/// change nothing one could see.
constexpr double contact_accuracy = 2e-4;

/// Share of h. How far a sticking contact gives before it slides. Larger: cloth creeps visibly before it holds. Smaller: the
/// springs of friction get so stiff that Newton takes longer.
constexpr double stick_reach_share = 0.01;

/// Times h, the zone that a detector is asked for when contact is projected: rows have to be known before they touch, and cloth
/// at rest lies at h itself. 1: rows come and go there. Larger: more rows that never touch.
constexpr double projection_zone = 1.2;

/// Share of its stiffness that a row has to take to be handed forces of others. Smaller: forces go to rows that hardly act.
constexpr double least_handed_share = 0.5;

/// Cosine between the directions of rows that hand forces over. Less: they may lie on two sides of a gap. 1: forces stay behind
/// where facets turn.
constexpr double least_handing_cosine = 0.9;

/// Share of the step matrix that the stiffness of a projected row has. Smaller: more rounds of multipliers. Larger: each takes
/// Newton longer.
constexpr double projection_stiffness_share = 1.0;

/// s, in which cloth that starts too near comes back to h. Shorter: it is thrown off. Longer: it stays nearer than it should.
constexpr double thickness_recovery_time = 0.05;

/// Share of the zone beyond its target within which a row's force has ended. 1: rows that leave the zone still push.
constexpr double multiplier_zone_share = 0.9;

/// Share of the step matrix that the contact stiffness takes. Smaller: cloth sinks in. Larger: Newton takes longer.
constexpr double penalty_stiffness_share = 0.5;

/// Times what presses on a row, over h: its least stiffness. At 4 cloth rests at no less than 3/4 h.
constexpr double static_load_factor = 4.0;

/// Share of h that an obstacle comes or goes in a step; from there on contact stiffness is all that of this step's length.
/// Smaller: obstacles that hardly move throw up what lies on them. Larger: fast ones meet cloth that is too soft.
constexpr double moving_obstacle_share = 0.2;
/// Share of h within which contact in a span shorter than its step stops cloth at the speed of a moving obstacle. Stages of
/// TR-BDF2 are as stiff as their length makes them where the obstacle moves by moving_obstacle_share. Smaller: adaptive steps
/// throw cloth.
constexpr double stopping_share = 1.0 / 12.0;

/// Share of h. A row is not taken to have been nearer at a move's start: the ledger's potential there has no bound.
constexpr double least_start_share = 1e-3;

// ---- schemes/: the longest stable step of a Runge-Kutta scheme is searched along a ray, in units of 1/|lambda|

/// Shorter stable steps count as none. And the factor from one trial to the next. Larger: a gap of the stable region may be
/// stepped over. Cost.
constexpr double least_stable_step = 1e-6, stable_step_march = 1.02;

/// Share of |R| that rounding adds to 1. 0: stable steps are found unstable.
constexpr double growth_rounding = 1e-12;

/// Where the search ends: no Taylor polynomial of degree 4 or less is stable there. Halvings of the interval in which stability
/// is lost; 53 exhaust a double.
constexpr double beyond_stable_step = 4.0;
constexpr int stable_step_halvings = 60;

// ---- linear/

/// Iterations of block Jacobi from which multigrid is cheaper, and after which a solve is left to it. Times the iterations of the
/// first solve with coarser levels, and iterations more: from there on these are made anew. Cost alone.
constexpr int dear_jacobi_iterations = 25, most_jacobi_iterations = 40;
constexpr int stale_level_factor = 2, stale_level_excess = 2;

/// Vertices, up to which `automatic` factorises where iterative solvers are not exact enough. More: steps of seconds. Fewer:
/// small cloth with slivers is not solved exactly.
constexpr int most_factorised_vertices = 2000;

/// Vertices of the largest bottom level of multigrid, which is inverted densely. Cost alone.
constexpr int dense_vertices = 30;

/// Damping of the block Jacobi smoother. It leaves eigenvalues up to 2 for springs and up to about 2.8 on coarser levels: damped
/// by more than 2/2.8 it would amplify them. (Chebyshev polynomials of degree two need fewer cycles, but each reads the matrix
/// twice as often.)
constexpr float jacobi_damping = 0.7f;

/// Times that at vertices sewn to points, whose eigenvalues go up to 3. 1: conjugate gradient takes hundreds of iterations where
/// sewn points are stiffer than the cloth.
constexpr float sewn_point_easing = 2.0f / 3.0f;

/// Sweeps over contact rows that filter what multigrid hands to coarser levels and back, where rows between cloths are stiffer
/// than this many times their vertex along all axes together. Cost alone: softer rows gain less than the sweeps take.
constexpr int row_sweeps = 3;
constexpr double stiff_row_factor = 1.0;

/// Pairs in a thread's part, and from which the work is shared out. Cost alone.
constexpr int pair_grain = 512, least_shared_pairs = 2048;
constexpr int row_grain = 256, least_shared_rows = 512;  // of contact

/// Coefficient of a finer pair's block in a coarser one. Smaller ones are left out. Larger: coarser levels miss stiffness.
constexpr double least_galerkin_coefficient = 1e-4;

/// Share of vertices that a coarser level may keep; with more it gains nothing and the hierarchy ends.
constexpr double most_coarse_share = 0.8;

/// Levels of multigrid. Fewer: the bottom may be too large to be inverted. Vertices of one that are sorted by degree together:
/// cost alone.
constexpr int most_multigrid_levels = 12, level_sorting_window = 128;

/// Share of the strongest pair at one end from which a pair is strong; the second where the first keeps too many vertices.
/// Larger: coarser levels stay large. Smaller: they are poor where springs differ in stiffness.
constexpr double strong_pair_share = 0.25, lower_pair_share = 0.03;

/// Share of vertices kept, above which weaker pairs count too.
constexpr double most_kept_share = 0.4;

/// Share of the largest interpolation weight below which a weight is dropped. Smaller: denser levels.
constexpr double least_weight_share = 0.03;

/// Added to the second moment for each candidate: all may lie in a plane, or on a line. 0: a singular matrix.
constexpr double moment_regularisation = 1e-3;

/// m^2. Squares of distances between candidates are at least this, so that none divides by 0.
constexpr double least_candidate_square = 1e-24;

/// Share of the residual to which floats are trusted. Smaller: iterations that gain nothing. Larger: more refinements.
constexpr double float_residual = 1e-4;

/// Refinements of a solve in floats by residuals in doubles; the share of the wanted residual that one aims at; and the share of
/// the residual before that it may leave: with more, floats have broken down.
constexpr int most_refinements = 12;
constexpr double float_aim_share = 0.5, most_refined_share = 0.5;

/// Ratio of energy gains from one window to the next. Below it they fall fast, and what is likely to come is estimated by the
/// last window alone. Larger: badly conditioned systems count as solved too early. (Inline, as a header reads it.)
inline constexpr double slow_gain_ratio = 0.8;

/// The largest ratio that the sum of what is to come is taken with. 1: no bound.
inline constexpr double most_gain_ratio = 0.99;

// ---- plan/

/// Iterations for the highest frequency. Fewer: it is found too low, and the stable step too long.
constexpr int power_iterations = 40;

/// Share of the estimated stable step that `automatic` takes. 1: the estimate is a bound from above, cloth may fly apart.
constexpr double stable_step_share = 0.8;

/// s. What `automatic` takes adaptive TR-BDF2 to need where it compares costs.
constexpr double usual_implicit_step = 1.0 / 240;

/// w dt of trapezoid and implicit midpoint from which a plan warns that they ring.
constexpr double most_ringing_phase = 3.0;

/// Vertices, above which a plan warns of one Newton iteration a step.
constexpr int fine_sheet_vertices = 4000;

/// Parts of a step, far more than are cheaper than an implicit one.
constexpr int most_explicit_parts = 1000;

/// Share of a spring's length by which forces of triangles and hinges are differenced. Smaller: rounding. Larger: curvature.
constexpr double shape_difference_share = 1e-5;

// ---- solve/

/// Trials of one line search. Fewer: steps are taken that lower nothing.
constexpr int most_line_trials = 10;

/// Slopes beyond the minimum, over the first one's size, up to which a step is taken whatever the objective says: friction is
/// not in it, and steps that overshoot by more go to and fro for ever. Less where contact is projected, unless the step changes
/// little: rows that were in no matrix stop the cloth half-way, and the next step would lead back as far.
constexpr double most_turned_slope = 0.9, most_projected_slope = 0.3;

/// The same where the objective is flat to rounding or not known, and the slope decides.
constexpr double gentle_slope = 0.9;

/// Share of the first slope by which the objective has to fall (Armijo's rule). Towards 1: good steps are shortened.
constexpr double armijo_share = 1e-4;

/// Share of the objective that it may rise and count as flat. 0: rounding refuses the last steps of a solve.
constexpr double flat_objective = 1e-9;

/// Slope over the objective: what slopes say below is rounding. 0: a search at the solution never ends.
constexpr double flat_slope = 1e-12;

/// The least and the largest factor of the next trial, and the one where the secant says nothing.
constexpr double least_shortening = 0.15, most_shortening = 0.6, blind_shortening = 0.5;

/// Share of the first slope that is left after a full step, from where on going further pays for its evaluation.
constexpr double slope_left_share = 0.6;

/// Steps by the secant, the longest; and the least fall of the slope, as a share of it, that the secant divides by.
constexpr double longest_secant_step = 3.0, least_secant_fall = 0.1;

/// Of a slope that has turned, what rows must make that were out of reach, for another direction to be found with them in the
/// matrix. Larger: the step is shortened instead, again and again while sheets land. Smaller: directions are found in vain.
constexpr double foreseen_slope_share = 0.5;

/// Share of what a change may be (StepSettings::newton_share) where it is only estimated. Larger: changes that are not small are
/// taken for small. Smaller: more iterations.
constexpr double estimate_safety = 0.4;

/// Of StepSettings::newton_share in adaptive steps. Larger: the tolerance is missed by the solver's error.
constexpr double most_adaptive_share = 0.25;

/// Newton iterations of a solve after which patches are relaxed. Fewer: solves that soon end pay for it. More: layers that slide
/// on each other take two to three times as many.
constexpr int iterations_before_patches = 8;

/// Vertices that patches begin with, at most: a share of all, but not less than a number. More: patches cost what all cloth does.
constexpr double most_patched_vertices = 0.02;
constexpr int few_patched_vertices = 20;

/// Shares of the residual's square: what these vertices are taken to hold, and what they must hold for patches to pay.
constexpr double patched_square = 0.95, least_patched_square = 0.8;

/// When patches are relaxed: at this share of their residual, or after so many iterations.
constexpr double patch_residual_share = 0.1;
constexpr int most_patch_iterations = 8;

/// The same of the linear systems of patches. Smaller, more: exactness that the next state of contact makes useless.
constexpr double patch_linear_share = 0.1;
constexpr int most_patch_linear_iterations = 200;

/// Rounds of contact multipliers in one stage. Fewer: projected contact is left inexact.
constexpr int most_contact_rounds = 6;

/// Share of h at most: contact less exact takes another round, however large the time error is.
constexpr double contact_round_share = 0.01;

/// h over the smallest change that means something without contact (2e-5 h). Smaller: cloth near rest is left unsolved.
constexpr double thickness_over_smallest_change = 5e4;

/// Share of an adaptive stage's allowance below which a change means nothing.
constexpr double negligible_allowance_share = 0.1;

/// Relative. Moves below it are rounding of positions (a few units in the last place of a double).
constexpr double position_rounding = 1e-15;

/// Squares of lengths that are smaller by this factor are smaller but for rounding. Cost alone.
constexpr double strain_rounding = 1.0 - 1e-12;

/// How much more a cloth's worst vertex may change than its mean: times the share of its time error, times what means nothing.
constexpr double worst_vertex_factor = 2.0, worst_vertex_floor_factor = 10.0;

/// Energy norm, relative. Accuracy of the linear solve. Larger: more Newton iterations. Smaller: each is dearer.
constexpr double linear_energy_accuracy = 0.2;

/// Share of its momentum that a linear solve with contact may leave a body that nothing holds. Larger: sheets that slide tremble,
/// and cloth rubs too much on cloth. Smaller: more linear iterations.
constexpr double net_momentum_share = 0.05;

/// Relative residual at which a linear solve ends, whatever its energy.
constexpr double least_linear_residual = 1e-10;

/// With a residual to reach, the linear residual follows Newton's: factor of the squared ratio, its least and its largest value
/// (Eisenstat and Walker 1996, choice 2, gamma = 0.9).
constexpr double forcing_factor = 0.9, least_forcing = 1e-6, most_forcing = 0.1;

/// Share of the residual to reach that the last linear solve aims at, and the largest linear residual at all.
constexpr double last_forcing_share = 0.3, loosest_forcing = 0.3;

// ---- span/: impacts

/// h per second. Beside what gravity makes in a stage: what comes more slowly is in no impact. Larger: bounces end early. 0: they
/// never do, and contacts that last are taken for impacts.
constexpr double least_impact_rate = 2.0;

/// What is left of an impact's speed in each step after it was stopped; until it is slow, contact cannot make it leave. Larger:
/// contacts that last are taken for impacts. Smaller: contact that is still compressed throws it off.
constexpr double impact_fading = 0.9;

// ---- span/: lengths of adaptive steps

/// s. The first step: short, as a start may let go of something stiff.
constexpr double first_adaptive_step = 5e-5;

/// s. Shorter steps are accepted whatever their error. Longer: errors go unnoticed. Shorter: impacts take for ever.
constexpr double shortest_step = 1e-7;

/// Share of the allowance that the next step aims at. Towards 1: more rejected steps. Smaller: more steps.
constexpr double wanted_error_share = 0.5;

/// The least share that an error counts as, so that no step grows without bound after one without error.
constexpr double least_error_share = 1e-6;

/// s of allowance: what can be left over, and what a step in contact has at least. Larger: errors exceed the tolerance for as
/// long. 0 in contact: impacts, whose error goes with dt, force the shortest step.
constexpr double most_left_allowance = 0.02, least_contact_allowance = 0.005;

/// Exponents of the PI controller (Soderlind 2002), over the order. Larger: lengths swing to and fro.
constexpr double control_proportional = 0.4, control_integral = 0.7;

/// Factors from one length to the next: the least, the largest; after a rejected step the largest, and a factor of safety.
constexpr double least_length_factor = 0.2, most_length_factor = 2.0, most_rejected_factor = 0.5, rejected_safety = 0.9;

/// Share of a count of steps. What is left of the time is divided into one step less if it is longer by only this. 0: rounding
/// adds a step of no length.
constexpr double step_count_rounding = 1e-9;

// ---- step/

/// s per second: how fast the time step that contact stiffness is made for may become shorter. Stiffness goes as 1/dt^2, and
/// what a stiffer contact stores nobody has paid for; slowly against its own period, 2 pi sqrt(2) dt, it stores nothing.
constexpr double fastest_contact_shortening = 0.05;

/// s for which cloth has to be still to sleep, and share of h that it may move meanwhile. Shorter, larger: slow cloth freezes.
/// Longer, smaller: cloth at rest is solved for ever.
constexpr double rest_time = 0.5, rest_displacement_share = 0.002;

/// Share of a vertex's weight that forces on it may leave in cloth at rest. Larger: a swing sleeps where it turns.
constexpr double rest_force_share = 0.02;

/// RestState::unrest grows by the first with each step in which the potential rises and falls by 1 in each other, so that it
/// grows where every third step rises. From the second on each step stops cloth for so many s. Smaller: a swing creeps to rest.
constexpr int unrest_of_rise = 3, most_unrest = 12;
constexpr double stopping_time = 2.0 * rest_time;

/// Radians, and times the thickness: what an obstacle turns and moves by in one part of a step, and what a pin moves by. Larger:
/// parts that vertices on straight lines do not follow, and lists of contacts that grow. Smaller: more parts.
constexpr double largest_part_turn = 0.26179938779914943, largest_part_travel = 20.0, largest_pin_travel = 80.0;

/// m or m/s. Positions and velocities that a program gives. Larger: squares lose all digits, or are infinite.
constexpr double largest_given_number = 1e9;

/// Newton iterations of a step whose time is up in which what moves has to arrive, or the step fails. Smaller: steps fail that
/// would have arrived. Larger: those that do not arrive hold up their host for longer.
constexpr int most_late_iterations = 20;

/// Parts of a step. More: steps of many seconds, that fling cloth. Rounding: what a count of parts may be above a whole number;
/// m, by which a pin that goes with an obstacle may miss its place on it.
constexpr int most_step_parts = 64;
constexpr double part_rounding = 1e-9, carried_pin_error = 1e-8;

/// Parts of a step that the travel of one thing asks for, from which the report says that it may have jumped.
constexpr int jump_parts = 8;

/// Strain of held cloth that the report of a step that failed, or did not converge, tells of.
constexpr double told_strain = 1.0;

/// Halvings of one span, one inside the other: the shortest is 1/64 of it. Fewer: hard impacts end as steps that did not
/// converge. More: a step that cannot converge costs twice as much with each before it says so.
constexpr int most_halvings = 6;

/// s, m. Time in which a weld takes up its gap, and the gap of which its spring's force is the most that it holds with. Shorter:
/// stitches swing. Wider: a seam that something keeps open pulls harder and harder.
constexpr double weld_time = 0.05, widest_weld = 0.01;

/// N/m: an edge that holds nothing, as its ends are sewn together, limits as if it held that. 0: divides by 0.
constexpr double least_limited = 1e-12;

/// Strain limits: k and the most hold over an edge's own stiffness; s, in which a hold takes up what is too much. Larger k: more
/// iterations. Smaller: more steps until the limit is kept. Larger hold: what cannot be kept pulls ever harder.
constexpr double limit_stiffness = 10.0, most_held_strain = 2.0, limit_time = 1.0 / 60.0;

// ---- step/: obstacles that yield

/// Surfaces give way from this share of the room on that two contact zones have, which is where cloth between them begins to be
/// pressed. Larger: they have given way before the contacts that tell of it are there. Smaller: cloth is pressed hard.
constexpr double kept_room = 0.6;

/// h of room more than is kept, of which dents do not make use; and h by which they go back in a step. Slack 0: dents go back and
/// forth for ever. Larger: they stay deeper than they have to. Return larger: where cloth is just out of contact they come too
/// near, are pushed back, and tremble. Smaller: dents last.
constexpr double dent_slack = 0.2, dent_return = 0.25;

/// h. A dent that would change by less, and cloth that goes by less in a step, is at rest. 0: no dent rests. Larger: it stays
/// where it should change.
constexpr double resting_dent = 0.02;

/// h, and mean edges: how far around a pressing point the surface goes along. Smaller: spikes. Larger: dents wider than the
/// cloth.
constexpr double dent_thicknesses = 4.0, dent_edges = 2.0;

/// By how much more the corners around a pressing point go back than it has to, since a point inside a triangle goes less.
/// Smaller: more steps until there is room. Larger: more room than is kept.
constexpr double beyond_press = 1.2;

/// Weight in a contact from which on it presses a vertex, and share of a retreat below which a vertex has not moved. Larger:
/// pairs that pinch are not seen. Smaller: places that hardly matter count.
constexpr double least_pressing_weight = 0.05, least_dent_share = 0.1;

/// Cosines between the directions of two contacts: at most that of those on opposite sides of cloth, at least that of those on
/// one. Nearer to 0: surfaces beside each other count as a pinch. Farther: slanted ones are not seen.
constexpr double opposite_sides = -0.5, same_side = 0.5;

/// Passes over contacts between cloths; each sees through one layer at least. Fewer: thick bundles are pinched unseen.
constexpr int yielding_passes = 3;

/// Into how many equal parts a step is divided, in turn, where a surface came up too fast to give way in time. Cost alone, but
/// for the last: what is too fast for it fails.
constexpr int yielding_parts[] = {4, 16, 64};

// ---- checks/: derivatives against differences, for settings.check_derivatives. Smaller: right forces are found wrong. Larger:
// wrong ones pass.

/// Share of the vertex's own value, and of the largest of all.
constexpr double derivative_accuracy = 1e-4, derivative_floor_accuracy = 1e-5;

/// Share that rounding leaves of sums of forces and of energies.
constexpr double derivative_rounding = 1e-12;

/// Stretches of vertices whose energy slope is compared by itself. Fewer: a wrong force hides among more right ones.
constexpr int derivative_stretches = 16;

/// Share of the shortest spring, by which vertices are moved. Times that reach: how near the kinks of wind (as a distance in dt),
/// of contact and of strain limits a vertex is left out.
constexpr double derivative_reach_share = 1e-5, wind_kink_reaches = 1e3, contact_kink_reaches = 10.0, limit_kink_reaches = 4.0;

// ---- start/

/// Strain that a repaired start may have (where it had less before), and where relaxing it ends. Larger: torn starts are taken.
constexpr double most_start_strain = 0.5, good_start_strain = 0.1;

/// How often cloth leaves obstacles and cloth in turn. Fewer: what was moved out of one is left in the other. Cost, of hopeless
/// starts.
constexpr int most_repair_turns = 8;

/// Steps of relaxing, and their length in s.
constexpr int most_relaxations = 60;
constexpr double relaxation_step = 1.0 / 60.0;

/// Share by which strain has to fall, and steps in a row without after which relaxing is over. Fewer: starts are refused that
/// would have relaxed.
constexpr double relaxed_share = 0.01;
constexpr int most_idle_relaxations = 10;

/// Share of h. Vertices that a repair moved by less are not told of.
constexpr double told_move_share = 0.1;

}  // namespace percale
