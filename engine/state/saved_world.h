#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "percale/report.h"
#include "step/world.h"

namespace percale {

/// Expected size of saved states in bytes, for which memory is allocated at once.
struct SavedSize {
    std::size_t whole = 0, detector = 0;
};

/// All that the coming steps depend on, sealed (percale/saved_state.h), and the moves that the start needed. Cloth, seams,
/// obstacles and settings are held as hashes only. Throws SceneError where the detector cannot save its state. `size`: of the
/// last state on entry, of this one on return.
std::vector<std::byte> saved_world(const World& world, const std::vector<StartMove>& start_moves, SavedSize& size);

/// Restores such a state into a world made by the same calls, its views excepted; returns the moves that the start needed.
/// Throws SceneError, and leaves the world as it was, for bytes that are incomplete or belong to another world.
std::vector<StartMove> restore_world(std::span<const std::byte> bytes, World& world);

}  // namespace percale
