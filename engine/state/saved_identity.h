#pragma once

#include <cstdint>

#include "step/world.h"

namespace percale {

/// What a world is made of, as checksums: a saved state goes into a world of the same. It does not change from step to step.
struct Identity {
    std::uint64_t cloth = 0, obstacles = 0, settings = 0;
};
Identity identity_of(const World& world);

}  // namespace percale
