#pragma once

#include <cstddef>
#include <numbers>

/// The numerical constants of the layer that decide something and that several files use; one with a single user stands there.
namespace percale::scenes {

// ---- models/, meshes/

/// How often a file may place its parts, in vertices: so many always, or so many times what it holds. Without a limit a short
/// file fills the memory.
constexpr std::size_t always_allowed_vertices = 100000, max_part_copies = 64;

/// Morph targets of a mesh that an animation may name: the number of one takes as many weights.
constexpr unsigned max_morph_targets = 4096;

// ---- bodies/

/// Fraction of the body's diagonal. In a loop the last shape is the first one where no vertex is farther off. 0: rounding of a
/// file adds a frame that stands still.
constexpr double same_shape = 1e-4;

// ---- run/

/// Radians, and times the thickness: what an obstacle turns and moves by in one part of a step. Larger: parts that the path of
/// vertices on straight lines does not follow, and cloth that is blocked. Smaller: more parts.
constexpr double largest_part_turn = std::numbers::pi / 12.0, largest_part_displacement = 4.0;

/// Fraction of a part by which a count of parts may be above a whole number.
constexpr double part_rounding = 1e-9;

/// Strain from which a run warns that cloth would have torn. Smaller: it warns of knits that stretch.
constexpr double torn_strain = 1.0;

// ---- doctor/: from where on it warns. Smaller or larger: warnings of what is right, or none of what is wrong.

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

/// m. Larger coordinates are refused, as the collision layer refuses them.
constexpr double largest_coordinate = 1e75;

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

// ---- compare/

/// m, how far each free vertex is moved at the start to see how disturbances grow, and the growth from which a scene is chaotic:
/// positions cannot be compared then. Larger growth: errors of chance are taken for errors of schemes.
constexpr double disturbance_at_start = 1e-6, chaos_growth = 1000.0;

/// s. The step that searches for a surviving one begin with, and how often it is halved.
constexpr double largest_compared_step = 1.0 / 60.0;
constexpr int max_step_halvings = 14;

// ---- stress/

/// Steps of a cell, if not said otherwise. Just beyond their limit explicit schemes grow slowly, and their steps are cheap: they
/// make so many times more of them. Fewer: what grows slowly is taken for stable.
constexpr int usual_steps = 16, explicit_factor = 8;

}  // namespace percale::scenes
