#pragma once

#include <cstdint>

#include "step/world.h"

namespace percale {

/// Checksums of everything that a world is made of and that no step changes: a saved state goes into a world with the same ones.
struct Identity {
    std::uint64_t cloth = 0, obstacles = 0, settings = 0;
    std::uint64_t numbers = 0;  // which of the added bodies still exist
};
Identity identity_of(const World& world);

/// Throws SceneError unless a state that was saved in one world may go into another.
void demand_same(const Identity& saved, const Identity& own);

}  // namespace percale
