#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lists/candidate_lists.h"
#include "percale/saved_state.h"

namespace percale {

/// Distinguishes cloth and obstacles from others, wherever they are.
std::uint64_t scene_hash(const std::vector<Triangle>& triangles, const std::vector<double>& vertex_thickness,
                         const Obstacles& obstacles);

/// Where an obstacle is at the start and the end of a step; shapes of deforming ones alone.
struct SavedMotion {
    Pose start, end;
    std::vector<Vec3> start_shape, end_shape;  // m, of the given vertices before the pose
};

void save_motions(const Obstacles& obstacles, StateWriter& state);
/// Reads motions as they were saved. Throws SceneError for those of another size.
std::vector<SavedMotion> restored_motions(const Obstacles& obstacles, StateReader& state);
/// Puts the obstacles there.
void set_motions(std::span<const SavedMotion> motions, const Obstacles& obstacles);

/// Saves everything that later calls depend on, all bounds and persistent contacts, with the obstacles as they are now: a resumed
/// run does not depend on when lists were made.
void save(const CandidateLists& candidates, const Obstacles& obstacles, StateWriter& state);

/// Lists as they were saved, of the same cloth and obstacles. Throws SceneError for what is none of these. Obstacles may still be
/// elsewhere, but must be where they were when CandidateLists::settle is called, which is before anything else. `known`: others
/// of the same cloth, whose clusters are taken where they are the same; null: none.
CandidateLists restored_lists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                              const Obstacles& obstacles, const CandidateLists* known, StateReader& state);

}  // namespace percale
