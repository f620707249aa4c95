#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lists/candidate_lists.h"
#include "percale/saved_state.h"

namespace percale {

/// Tells cloth and obstacles from others, wherever they are.
std::uint64_t scene_hash(const std::vector<Triangle>& triangles, const std::vector<double>& vertex_thickness,
                         const Obstacles& obstacles);

/// Poses of the obstacles at the start and the end of a step, as they were saved. Throws SceneError for those of another size.
std::vector<std::array<Pose, 2>> restored_poses(const Obstacles& obstacles, StateReader& state);

/// Everything that later calls depend on, all bounds and standing contacts: a resumed run does not depend on when lists were
/// made. With the obstacles as they are now.
void save(const CandidateLists& candidates, const Obstacles& obstacles, StateWriter& state);

/// Lists as they were saved, of the same cloth and obstacles. Throws SceneError for what is none of these. Obstacles may still be
/// elsewhere, but must be where they were when CandidateLists::settle is called, which is before anything else.
CandidateLists restored_lists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                              const Obstacles& obstacles, StateReader& state);

}  // namespace percale
