#pragma once

#include "lists/candidate_lists.h"

namespace percale {

/// One obstacle is no longer there, later ones have numbers less by one. `version`: of all, with it; lists that were good for
/// that are so for those that are `left`. What lists know of these stays, standing contacts, too.
void remove_obstacle(int obstacle, int version, const Obstacles& left, ListsMemory& memory);

}  // namespace percale
