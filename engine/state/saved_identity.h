#pragma once

#include <cstdint>

#include "step/world.h"

namespace percale {

/// What a world is made of, as checksums: a saved state goes into a world of the same. It does not change from step to step.
struct Identity {
    std::uint64_t cloth = 0, obstacles = 0, settings = 0;
    std::uint64_t numbers = 0;  // which of the bodies that were added are there
};
Identity identity_of(const World& world);

/// Throws SceneError unless a state that was saved in one world may go into another.
void demand_same(const Identity& saved, const Identity& own);

}  // namespace percale
