#pragma once

#include "force_term.h"

namespace percale {

/// Forces of welded stitches (model/weld.h). They do not change within a step, so the matrix has no part of them: the stiffness
/// is that of their springs.
const ForceTerm& welding_term();

}  // namespace percale
