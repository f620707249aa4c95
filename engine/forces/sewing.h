#pragma once

#include "force_term.h"

namespace percale {

/// Vertices sewn to points (SewnPoint). The force that draws u to zero is among the springs (SpringNetwork::bending); the term
/// itself holds u at its length while the seam closes: the load k l w d on each vertex, w its weight in u. That load has a fixed
/// direction in space, so that a closing point may turn the cloth.
const ForceTerm& sewing_term();

/// Forces of welded stitches (model/weld.h). They do not change within a step, so the matrix has no part of them: the stiffness
/// is that of their springs.
const ForceTerm& welding_term();

}  // namespace percale
