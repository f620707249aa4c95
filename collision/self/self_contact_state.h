#pragma once

#include "percale/saved_state.h"
#include "self/self_contact_lists.h"

namespace percale {

/// Saves everything that later calls depend on: a resumed run does not depend on when lists were made.
void save(const SelfContactLists& lists, StateWriter& state);

/// The state that lists of the same cloth as these have saved. Throws SceneError for any other.
SelfListsState restored_state(const SelfContactLists& lists, StateReader& state);

}  // namespace percale
