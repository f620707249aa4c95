#pragma once

#include <array>
#include <span>
#include <vector>

#include "format/scene.h"
#include "percale/stitch.h"

namespace percale::scenes {

/// Throws SceneError where no cloth has the name.
int cloth_number(const Scene& scene, const std::string& name);

/// The numbers of the cloths that a seam joins.
std::array<int, 2> seam_cloths(const Scene& scene, const SeamSpec& seam);

/// All stitches of a seam: of its vertices, its points and its file. Throws SceneError for a file that cannot be read, or where
/// "mesh" is that of no cloth.
std::vector<Stitch> seam_stitches(const Scene& scene, const SeamSpec& seam);

/// Stitches between two cloths of a list.
struct ClothStitches {
    std::array<int, 2> cloths = {0, 0};
    std::vector<Stitch> stitches;
};

/// The stitches among the vertices of all cloths, counted through one after the other. `first_vertex`: of each; -1: it is left
/// out, with its stitches.
std::vector<Stitch> joined_stitches(std::span<const ClothStitches> seams, std::span<const int> first_vertex);

}  // namespace percale::scenes
