#pragma once

#include "percale/saved_state.h"
#include "self/self_contact_lists.h"

namespace percale {

/// Everything that later calls depend on: a resumed run does not depend on when lists were made.
void save(const SelfContactLists& lists, StateWriter& state);

/// What was saved by lists of the same cloth as these. Throws SceneError for what is none of these.
SelfListsMemory restored_memory(const SelfContactLists& lists, StateReader& state);

}  // namespace percale
