#pragma once

#include <cstddef>

/// The numerical constants of the layer that affect a decision and that several files use; one with a single user stands there.
///
/// A constant marked "cost alone" adds and removes no contact: it changes what is stored, queried and measured. It may still
/// change a clamp, and with it the bits of a run: a pair that a bound excludes may use up all of its clearance (distance less
/// floor), a measured pair keeps `clearance_left` of it. Lengths are given as fractions of the thickness, h: the distance below
/// which cloth is in contact, usually 1 mm to 10 mm.
namespace percale::tolerances {

// ---- Shared

/// Sine of an angle. A face next to a closest point rises towards the other side if it does so by more. It covers rounding alone:
/// at 0 a contact above an edge of flat cloth or of a flat obstacle may belong to neither of its triangles and be lost.
constexpr double rising_sine = 1e-9;

/// Factor. It exceeds what a number loses when it is rounded to single precision (6e-8). Below 1 + 6e-8 a bound may be above what
/// it bounds, and a contact is missed.
constexpr float rounded_up = 1.000001F;

// ---- geometry/

/// Fraction of h. The distance that a clamp leaves where there was more than twice as much. 0: distances collapse to rounding,
/// where the direction of a contact is lost. Larger: cloth is stopped farther out within the activation distance.
constexpr double clamp_floor = 0.2;

/// Fraction of the clearance (distance less floor) at which conservative advancement stops: a clamp leaves it. Smaller: longer
/// safe moves for more advances. Larger: clamps fall short of what is safe.
constexpr double clearance_left = 0.1;

// ---- obstacle/

/// m. A bound without information: it is below any distance.
constexpr float no_bound = -1e30F;

// ---- lists/

/// Fraction of a move. Below it lists are made however many packs they hold. 0: the search might never end.
constexpr double min_covered_fraction = 1e-4;

// ---- self/

/// Cloth against cloth: how many lists a thread takes at once. More: threads wait for the last one. Fewer: they ask for work
/// more often.
constexpr std::size_t self_lists_a_part = 16;

/// Activation distance over the rest distance through a seam. Each side is sampled in its own way, so that edges from places
/// close to each other lie across each other where it is folded: at 0.5 such a fold cannot close below 60 degrees, and contact
/// holds the seam open. 0: nothing keeps its sides apart near it.
constexpr double seam_activation_ratio = 0.1;

// ---- certificate/ and the users of its trees. Nothing here decides whether triangles cross: that test is exact.

/// Fraction of a distance. A bound must exceed a distance by this much to exclude a pair, because of rounding (1e-15). 0: the
/// smallest distance may be that of the second nearest pair, in its last digits.
constexpr double bound_slack = 1e-9;

}  // namespace percale::tolerances
