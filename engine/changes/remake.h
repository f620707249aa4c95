#pragma once

#include <vector>

#include "model/cloth_model.h"
#include "model/seams.h"

namespace percale {

/// What a model is made anew for.
struct ModelChange {
    int cloth = -1;
    const Fabric* fabric = nullptr;  // that it is to have; null: it goes, and with it the seams that join it
};

struct RemadeModel {
    ClothModel model;
    std::vector<Seam> seams;       // those that are left, in their order
    std::vector<int> vertex;       // of each of before: its number now; -1: gone
    std::vector<int> seam_before;  // of each that is left: its number before
};

/// The model that the same calls make without a cloth, or with another fabric for it. Other cloths are copied, with what their
/// strain limits hold with; what the changed one's hold with begins anew. Seams keep lengths, directions and what their welds
/// hold with. Throws SceneError, as append_cloth does, for a fabric that the cloth cannot have.
RemadeModel remake(const ClothModel& before, const std::vector<Seam>& seams, const ModelChange& change);

}  // namespace percale
