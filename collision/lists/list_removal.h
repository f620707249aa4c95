#pragma once

#include "lists/candidate_lists.h"

namespace percale {

/// Removes one obstacle; the numbers of later ones decrease by one. `version`: of all obstacles, with this one; lists that were
/// valid for it are valid for the obstacles that are `left`. The state of their lists stays, persistent contacts included.
void remove_obstacle(int obstacle, int version, const Obstacles& left, CandidateListsState& memory);

}  // namespace percale
