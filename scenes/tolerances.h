#pragma once

#include <cstddef>
#include <numbers>

/// Every numerical constant of the layer that decides something. What is no choice stands where it is used: sizes of arrays,
/// limits of keys (format/), measures of shipped shapes and of the stress matrix's cells, layouts of pictures and tables, and
/// costs that were measured (doctor/doctor_scene.cpp, compare/compare_reference.cpp).
namespace percale::scenes {

// ---- report/

/// In the logarithm: a number that is a power of ten up to rounding gets no further decade in a plot.
constexpr double decade_rounding = 1e-9;

// ---- shapes/

/// Radians. A flip of an edge has to enlarge the smallest angle by more. 0: flips may go to and fro.
constexpr double min_flip_gain = 1e-6;

/// Cosine of the turn (60 degrees) that a triangle's normal may make by a flip or a merge. Smaller: surfaces fold over.
constexpr double min_normal_cosine = 0.5;

/// Radians (5 degrees). Merging vertices leaves no smaller angle. 0: needles. Larger: short edges stay.
constexpr double min_merged_angle = 5.0 * std::numbers::pi / 180.0;

/// Sweeps over all edges in one call. Fewer: meshes are left with flips to make.
constexpr int max_flip_sweeps = 30;

/// Fraction of the lattice's spacing by which a filled node lies inside. 0: triangles without area.
constexpr double filled_depth = 0.1;

/// m. Step of the differences for the mannequin's normals. Smaller: rounding. Larger: corners are rounded.
constexpr double normal_step = 1e-5;

/// Maximum number of Newton steps to the mannequin's surface, and the distance in m at which they end.
constexpr int max_surface_steps = 20;
constexpr double surface_error = 1e-12;

/// Rounds of relaxing the mannequin first and after each merge, merges, and the fraction of the spacing below which edges merge.
/// Other values give another mesh than the shipped one.
constexpr int mannequin_first_rounds = 4, mannequin_rounds = 5, mannequin_merges = 3;
constexpr double mannequin_merge_ratio = 0.5;

/// Points of a ring of the poncho before it is divided evenly, and directions in which its rows are counted.
constexpr int poncho_samples = 4096, poncho_directions = 64;

/// The same for the poncho.
constexpr int poncho_rounds = 10, poncho_last_rounds = 20, poncho_merges = 3;
constexpr double poncho_merge_ratio = 0.65;

// ---- models/, meshes/

/// Height of a triangle over its longest edge, in lengths of that. Flat ones have no area, as check_mesh of the engine has it:
/// if the two differ, `percale doctor` passes what a run refuses. Slivers are warned of.
constexpr double flat_height = 1e-12, sliver_height = 1e-2;

/// The number of largest solids that a part turned inside out is compared with before it counts as inverted. More: slower.
constexpr std::size_t max_solids = 100;

/// How often a file may place its parts, in vertices: so many always, or so many times what it holds. Without a limit a short
/// file fills the memory.
constexpr std::size_t always_allowed_vertices = 100000, max_part_copies = 64;

/// How often parts of a glTF file may use its numbers in the mean, each of which takes a byte at least. Less: bodies of many
/// materials that share their vertices are refused. More: a small file fills the memory.
constexpr std::size_t max_number_copies = 4;

/// Nodes of a file inside each other. More: the stack overflows.
constexpr int deepest_node = 1000;

/// What an importer of assimp may use for a file: bytes of memory, and so many for each byte of the file; s of CPU time,
/// likewise. Less: large good files are refused. More: broken ones take the machine longer.
constexpr std::uint64_t import_memory = 512ull << 20, import_memory_per_byte = 64;
constexpr double import_cpu_s = 10.0, import_cpu_s_per_byte = 2e-6;

/// Morph targets of a mesh that an animation may name: the number of one takes as many weights.
constexpr unsigned max_morph_targets = 4096;

/// Divisions of shapes that a scene names: a sphere's (4: 5120 triangles), and around the y axis. Cloth of finer mesh sees the
/// facets; more triangles cost more.
constexpr int sphere_level = 4, shape_segments_around = 48;

// ---- format/

/// Dots of a key. Each takes a call inside a call: without a limit a hostile file would exhaust the stack.
constexpr int deepest_key = 256;

// ---- garment/

/// kg/m^2, of cloth that nothing is said about: from silk gauze to chain mail. Outside a unit is likely wrong.
constexpr double lightest_cloth = 0.005, heaviest_cloth = 15.0;

/// m. How much farther out than the one below it the panels of a garment start. Smaller: panels start through those below.
constexpr double layer_offset = 0.04;

/// Ratio of a seam's sides from which on it is a gather: the longer one gets vertices between stitches. Larger: edges of the
/// longer side are pressed together. Smaller: eased seams are gathered.
constexpr double gathered_ratio = 1.1;

/// Relative to the square of the longest side: a triangle with less than this as twice its area has none. 0: ears along a line.
constexpr double min_turn = 1e-12;

/// Corners of a polygon that is cut into ears, which takes their square of time. More: seconds for one polygon.
constexpr std::size_t max_cut_corners = 10000;

// ---- bodies/

/// Fraction of the body's diagonal. In a loop the last shape is the first one where no vertex is farther off. 0: rounding of a
/// file adds a frame that stands still.
constexpr double same_shape = 1e-4;

/// Fraction of the body's diagonal. Vertices at one place that a clip moves apart by more are two. 0: rounding tears seams of
/// texture.
constexpr double moved_alike = 1e-6;

/// Times at which they are compared. Fewer: some part between them.
constexpr int times_compared = 9;

/// Ticks a second of a clip that does not say, 1/s: frames of a film, what files mean that do not.
constexpr double usual_ticks_per_s = 25.0;

/// Samples of a cache. More: its header is of another kind of file.
constexpr long max_samples = 1000000;

// ---- run/

/// Fraction by which a step may be longer than a frame without passing one by. 0: rounding warns.
constexpr double frame_rounding = 1e-9;

/// Pinches that `run` prints; the report has all.
constexpr std::size_t max_pinches_reported = 8;

/// Thicknesses of cloth, and fraction of an obstacle's area: where more of it has edges so long, it hardly gives way.
constexpr double coarse_edge_thicknesses = 12.0, reported_coarse_ratio = 0.05;

/// Steps. A pinch that pauses no longer is one. 0: every step in which a surface springs back and forth begins another.
constexpr double pause_of_pinch = 6.0;

/// Radians, and times the thickness: what an obstacle turns and moves by in one part of a step. Larger: parts that the path of
/// vertices on straight lines does not follow, and cloth that is blocked. Smaller: more parts.
constexpr double largest_part_turn = std::numbers::pi / 12.0, largest_part_displacement = 4.0;

/// Parts of a step. What moves still farther in a part may block the cloth.
constexpr double max_motion_parts = 1e5;

/// Fraction of a part by which a count of parts may be above a whole number.
constexpr double part_rounding = 1e-9;

/// Fraction of a cloth's bounding box, by which the box of a selection grows. 0: vertices on its rim are selected by chance.
constexpr double box_rounding = 1e-9;

/// Fraction of a step by which an event may be late for it: times are sums of steps. 0: events come a step late.
constexpr double event_rounding = 1e-9;

/// Fraction of a number of steps up to which a duration is a multiple of the step, and fraction of a step up to which the last
/// step takes a remainder along. 0: rounding adds a step of no length.
constexpr double whole_steps_rounding = 1e-9, min_last_step = 1e-3;

/// Strain from which a run warns that cloth would have torn. Smaller: it warns of knits that stretch.
constexpr double torn_strain = 1.0;

/// Strain from which a run and drape warn that a garment is tight. Smaller: it warns of knits made to stretch.
constexpr double tight_strain = 0.25;

/// Fraction of a strain limit by which cloth may exceed it without a warning.
constexpr double passed_limit_ratio = 0.1;

// ---- export/

/// Checkpoints of a run that is kept, over the longest that its scene may take. Fewer: more is run again after a kill. More: a
/// short scene spends its time writing.
constexpr double checkpoints_of_kept_run = 20.0;

// ---- doctor/: from where on it warns. Smaller or larger: warnings of what is right, or none of what is wrong.

/// Elements that a finding names.
constexpr std::size_t shown_elements = 4;

/// m. Meshes of bodies and garments are 0.1 to some 10 m large; from the first on they look like cm, from the second like mm,
/// and up to the third like a unit too much.
constexpr double centimetre_extent = 50.0, millimetre_extent = 500.0, tiny_extent = 2e-3;

/// Fraction of a cloth's median edge: rims nearer than that were likely meant to be one.
constexpr double near_rim_ratio = 0.05;
/// Times the widest gap between such rims: the weld that doctor names. Less: of several corners at a place, each as far from the
/// next, some stay apart.
constexpr double beyond_widest_gap = 2.0;
/// Fraction of the triangles that a weld may remove for doctor to name it: slivers may go, the shape may not.
constexpr double dropped_by_weld = 0.01;
/// Fraction of the median edge that doctor names as the gap between vertices at one place. Any joins them.
constexpr double same_place_ratio = 1e-6;
/// m, longest weld that a scene may ask for.
constexpr double max_weld = 0.1;

/// Times the mesh's size: farther from the origin rounding spoils its shape.
constexpr double farthest_extents = 1e4;

/// m. Larger coordinates are refused, as the collision layer refuses them.
constexpr double largest_coordinate = 1e75;

/// Pairs of triangles in a search for crossings: found; tested, for each triangle and at least. Fewer: it is left unknown whether
/// a mesh crosses itself. More: seconds.
constexpr long max_crossings = 1000, crossing_tests_per_triangle = 100, min_crossing_tests = 1000000;

/// Longest edge over the shortest.
constexpr double max_edge_ratio = 1e3;

/// Thickness over the median edge, that is advised where it is above 1.
constexpr double advised_thickness = 0.5;

/// Thickness over the distance from the origin: with less, gaps of a thousandth of it drown in rounding.
constexpr double min_thickness_of_place = 1e-5;

/// Size of a cloth over an obstacle's, or the reverse: from the first on they look like metres and centimetres, from the second
/// like metres and millimetres.
constexpr double centimetre_ratio = 50.0, millimetre_ratio = 500.0;

/// Edge of a cloth over an obstacle's second largest side: too long to lie around it, and what is advised; and over the
/// obstacle's median edge.
constexpr double coarse_edge = 0.5, advised_edge = 0.125, coarse_edge_ratio = 10.0;

/// Parts of a step from which a fast obstacle is a warning.
constexpr double dear_motion_parts = 100.0;

/// Shapes of a body that doctor looks at. More: it takes minutes.
constexpr int max_shapes_looked_at = 20000;

/// s, between two that doctor looks at. Less: as above.
constexpr double min_time_between_shapes = 1e-4;

/// Thicknesses that a vertex of a body that bends goes in a step that is made whole, as the engine has it.
constexpr double bending_part_travel = 20.0;

/// Parts of a step from which a body that bends likely has a frame that jumps.
constexpr double bending_jump_parts = 8.0;

/// Fraction of the longest stable step that is advised.
constexpr double advised_stable_ratio = 0.8;

/// Thicknesses that a repair of the start may move cloth before that is a warning.
constexpr double far_start_move = 2.0;

/// s, bytes, bytes: what a long run, much memory and much output are.
constexpr double much_time = 3600.0, much_memory = 8e9, much_disk = 1e10;

// ---- drape/

/// A garment of more m (`min_huge_garment`) and of more times the body's size (`huge_garment_ratio`) is in another unit than
/// m: in the one that makes it nearest to `garment_ratio` of the body. Smaller: tablecloths over cups are taken for centimetres.
/// Larger: a hat in centimetres is not.
constexpr double min_huge_garment = 8.0, huge_garment_ratio = 5.0, garment_ratio = 0.6;

/// m. A closed seam with a wider gap is said not to be sewn, and `drape` then fails. Smaller: tight gathers fail. Larger: seams
/// closed on the wrong side of a limb pass.
constexpr double widest_sewn_gap = 0.01;

/// s, after sewing: a seam that is open by more than that then does not close. Longer: garments that cannot be sewn take longer.
constexpr double late_closing = 1.0;

/// A body that is by this factor taller along z than along y stands along z. Smaller: spheres and beds do. Larger: people do not.
/// A flat thing, less deep along y than this fraction of its size, lies there and does not stand.
constexpr double standing_ratio = 1.5, min_standing_depth = 0.05;

/// m. A garment from a pattern that hangs lower than this since it was sewn, in the mean, has slid down. Smaller: it is reported
/// how far cloth gives by its own weight.
constexpr double far_slid = 0.1;

// ---- compare/

/// m, how far each free vertex is moved at the start to see how disturbances grow, and the growth from which a scene is chaotic:
/// positions cannot be compared then. Larger growth: errors of chance are taken for errors of schemes.
constexpr double disturbance_at_start = 1e-6, chaos_growth = 1000.0;

/// s. The step that searches for a surviving one begin with, and how often it is halved.
constexpr double largest_compared_step = 1.0 / 60.0;
constexpr int max_step_halvings = 14;

/// Stretch of an edge beyond which a finite end is none.
constexpr double torn_stretch = 10.0;

/// Changes that fall by less than this factor, as often in turn as a candidate has patience, have stopped falling.
constexpr double min_halving_progress = 1.25;

/// How much smaller a change may be than the one before it for Richardson's estimate. Below the minimum the change itself is
/// taken; above the maximum the estimate would be trusted too much.
constexpr double min_richardson_ratio = 2.0, max_richardson_ratio = 16.0;

/// Steps of each scheme, and tolerances of adaptive steps in m/s, where none are asked for.
constexpr int default_steps = 4;
constexpr double default_tolerances[] = {1e-2, 1e-3, 1e-4};

/// Fraction by which a rate of steps may differ from a whole number and still be written as 1/number.
constexpr double whole_rate_rounding = 1e-9;

// ---- pattern/

/// m. Panels that lie nearer to one plane lie in it. 0: rounding decides to which side they move apart.
constexpr double same_plane = 1e-6;

// ---- run/

/// Edges of a rest shape that are by more longer or shorter than those of the start are likely in another unit.
constexpr double max_rest_ratio = 2.0;

// ---- stress/

/// Steps of a cell, if not said otherwise. Just beyond their limit explicit schemes grow slowly, and their steps are cheap: they
/// make so many times more of them. Fewer: what grows slowly is taken for stable.
constexpr int usual_steps = 16, explicit_factor = 8;

/// Fractions of the energy put in: rounding; what backward Euler's unfinished solves may add to its bound of 0; and the bound of
/// schemes without a law of their own. Larger: a gain of energy passes.
constexpr double energy_rounding = 1e-9, unsolved_energy = 1e-6, doubled_energy = 1.0;

}  // namespace percale::scenes
