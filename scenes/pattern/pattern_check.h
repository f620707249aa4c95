#pragma once

#include "pattern/pattern.h"

namespace percale::scenes {

/// Throws SceneError for the first thing that cannot be sewn: no panel, an outline that is open or crosses itself, a panel
/// without area or of a size that no garment has, two panels in one place, sides of a seam that do not hang together or differ in
/// length by more than a quarter without `gather`. It names file, panel or seam, value and what is allowed.
void check_pattern(const Pattern& pattern);

}  // namespace percale::scenes
