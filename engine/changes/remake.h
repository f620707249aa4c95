#pragma once

#include <vector>

#include "model/cloth_model.h"
#include "model/seams.h"

namespace percale {

/// The reason for making a model anew.
struct ModelChange {
    int cloth = -1;
    const Fabric* fabric = nullptr;  // its new one; null: the cloth is removed, with the seams that join it
};

struct RemadeModel {
    ClothModel model;
    std::vector<Seam> seams;       // the remaining ones, in their order
    std::vector<int> vertex;       // for each earlier vertex: its number now; -1: removed
    std::vector<int> seam_before;  // for each remaining one: its earlier number
};

/// The model that the same calls make without a cloth, or with another fabric for it. Other cloths are copied, with the holds of
/// their strain limits; those of the changed one start from zero. Seams keep lengths, directions and the holds of their welds.
/// Throws SceneError, as append_cloth does, for a fabric that the cloth cannot have.
RemadeModel remake(const ClothModel& before, const std::vector<Seam>& seams, const ModelChange& change);

}  // namespace percale
