#pragma once

#include "percale/saved_state.h"
#include "self/self_contact_lists.h"

namespace percale {

/// Everything that later calls depend on: a resumed run does not depend on when lists were made.
void save(const SelfContactLists& lists, StateWriter& state);

/// Goes on from what was saved by lists of the same cloth. Throws SceneError, and changes nothing, for what is none of these.
void restore(SelfContactLists& lists, StateReader& state);

}  // namespace percale
