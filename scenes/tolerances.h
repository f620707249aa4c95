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

// ---- run/

/// Radians, and times the thickness: what an obstacle turns and moves by in one part of a step. Larger: parts that the path of
/// vertices on straight lines does not follow, and cloth that is blocked. Smaller: more parts.
constexpr double largest_part_turn = std::numbers::pi / 12.0, largest_part_displacement = 4.0;

/// Fraction of a part by which a count of parts may be above a whole number.
constexpr double part_rounding = 1e-9;

/// Strain from which a run warns that cloth would have torn. Smaller: it warns of knits that stretch.
constexpr double torn_strain = 1.0;

// ---- doctor/, drape/

/// m. Meshes of bodies and garments are 0.1 to some 10 m large; from the first on they look like cm, from the second like mm.
/// Smaller or larger: warnings of what is right, or none of what is wrong.
constexpr double centimetre_extent = 50.0, millimetre_extent = 500.0;

/// m, longest weld that a scene may ask for.
constexpr double max_weld = 0.1;

// ---- drape/

/// m. A closed seam with a wider gap is said not to be sewn, and `drape` then fails. Smaller: tight gathers fail. Larger: seams
/// closed on the wrong side of a limb pass.
constexpr double widest_sewn_gap = 0.01;

// ---- compare/

/// m, how far each free vertex is moved at the start to see how disturbances grow, and the growth from which a scene is chaotic:
/// positions cannot be compared then. Larger growth: errors of chance are taken for errors of schemes.
constexpr double disturbance_at_start = 1e-6, chaos_growth = 1000.0;

/// s. The step that searches for a surviving one begin with.
constexpr double largest_compared_step = 1.0 / 60.0;

// ---- stress/

/// Steps of a cell, if not said otherwise. Just beyond their limit explicit schemes grow slowly, and their steps are cheap: they
/// make so many times more of them. Fewer: what grows slowly is taken for stable.
constexpr int usual_steps = 16, explicit_factor = 8;

}  // namespace percale::scenes
