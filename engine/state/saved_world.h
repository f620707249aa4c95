#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "percale/report.h"
#include "step/world.h"

namespace percale {

/// Bytes that saved states take, for which memory is asked for at once.
struct SavedSize {
    std::size_t whole = 0, detector = 0;
};

/// All that the coming steps depend on, sealed (percale/saved_state.h), and what the start needed. Of cloth, seams, obstacles and
/// settings only hashes. Throws SceneError where the detector cannot save its state. `size`: of the last one, and then of this.
std::vector<std::byte> saved_world(const World& world, const std::vector<StartMove>& start_moves, SavedSize& size);

/// Takes such a state into a world made by the same calls, its views excepted; returns what the start needed. Throws SceneError,
/// and leaves the world as it was, for bytes that are not whole or belong to another world.
std::vector<StartMove> restore_world(std::span<const std::byte> bytes, World& world);

}  // namespace percale
